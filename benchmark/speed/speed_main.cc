// Times the search, the lattice planner, the verifier's walk and the shortcut
// refiner against other implementations, all in one run.
// Usage: terra-speed OUT.csv [MAPS]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <string>

#include "advisor/refiners.h"
#include "benchmark/map_generator.h"
#include "benchmark/speed/floor.h"
#include "benchmark/speed/peers.h"
#include "benchmark/speed/timing.h"
#include "bus/map_exchange.h"
#include "planner/coarse_lattice.h"
#include "terrain/digest.h"
#include "terrain/native_search.h"
#include "terrain/require.h"
#include "terrain/route_cost.h"
#include "terrain/search_steps.h"

namespace terra::benchmark {
namespace {

constexpr std::uint64_t kSeed = 2026;
constexpr int kRounds = 5;

struct Case {
  TerrainMap map;
  Cell start;
  Cell goal;
};

// A generated 500 x 500 case, each cell enlarged to scale x scale cells.
Case MakeCase(Subset subset, int index, int scale) {
  const GeneratedCase small =
      GenerateCase(subset, kSeed, index, CalibratedParameters(subset));
  if (scale == 1) {
    return {small.map, small.start, small.goal};
  }
  ByteRaster ids(small.map.height() * scale, small.map.width() * scale);
  for (Eigen::Index y = 0; y < ids.rows(); ++y) {
    for (Eigen::Index x = 0; x < ids.cols(); ++x) {
      ids(y, x) = small.map.ids()(y / scale, x / scale);
    }
  }
  const auto enlarge = [scale](Cell c) {
    return Cell{c.x * scale + scale / 2, c.y * scale + scale / 2};
  };
  return {TerrainMap::Create(std::move(ids), small.map.legend()).value(),
          enlarge(small.start), enlarge(small.goal)};
}

ArcGraph MakeArcs(const TerrainMap& map) {
  ArcGraph graph;
  graph.width = map.width();
  graph.num_nodes = map.width() * map.height();
  graph.min_cost = map.costs().min_cost();
  graph.first.push_back(0);
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      for (const Cell step : kSteps) {
        const Cell to{x + step.x, y + step.y};
        if (map.Passable({x, y}) && map.Contains(to) && map.Passable(to)) {
          graph.head.push_back(to.y * map.width() + to.x);
          const bool diagonal = step.x != 0 && step.y != 0;
          graph.weight.push_back(map.Cost(to) *
                                 (diagonal ? std::numbers::sqrt2 : 1.0));
        }
      }
      graph.first.push_back(static_cast<int>(graph.head.size()));
    }
  }
  return graph;
}

// Every search must return the same cost, or its time says nothing.
void RequireCost(double cost, double want) {
  TERRA_REQUIRE(std::abs(cost - want) <= 1e-9 * want);
}

void TimeSearches(const Case& c, std::vector<TimedSeries>& series) {
  NativeSearcher searcher;
  const double want = searcher.Search(c.map, c.start, c.goal).cost;
  const double baseline = planner::PlanOnLattice(c.map, c.start, c.goal).cost;
  const auto search = [&](const std::string& name,
                          NativeSearchOptions options) {
    return TimedWork{
        name, [&, options] {
          RequireCost(searcher.Search(c.map, c.start, c.goal, options).cost,
                      want);
        }};
  };
  std::vector<TimedWork> works = {
      search("search", {}),
      search("search, baseline's cost known", {.upper_bound = baseline}),
      search("search, portable", {.instructions = InstructionSet::kPortable})};
  if (InstructionSet::kAvx2 <= BestInstructionSet()) {
    works.push_back(
        search("search, AVX2", {.instructions = InstructionSet::kAvx2}));
  }
  RelaxOnce floor(c.map);
  works.push_back({"relax each cell once", [&] {
                     floor.Run();
                   }});
  ArcGraph arcs;
  std::vector<std::unique_ptr<Peer>> peers;
  if (c.map.width() <= 1000) {
    arcs = MakeArcs(c.map);
    const int start = c.start.y * arcs.width + c.start.x;
    const int goal = c.goal.y * arcs.width + c.goal.x;
    const auto add = [&](const char* name, std::unique_ptr<Peer> peer) {
      works.push_back({name, [&, start, goal, p = peer.get()] {
                         RequireCost(p->Search(start, goal), want);
                       }});
      peers.push_back(std::move(peer));
    };
    add("Boost.Graph A*", MakeBoostPeer(arcs));
    add("LEMON Dijkstra, reduced costs", MakeLemonPeer(arcs));
    add("textbook A*", MakeTextbookPeer(arcs));
  }
  TimeInterleaved(works, kRounds, series);
}

void TimeChain(const Case& c, std::vector<TimedSeries>& series) {
  const planner::LatticePlan plan =
      planner::PlanOnLattice(c.map, c.start, c.goal);
  const RouteWalk walk = WalkRoute(c.map, plan.waypoints);
  constexpr int kWalks = 100;
  double sum = 0;
  std::vector<TimedWork> works;
  works.push_back({"lattice r=50", [&] {
                     sum += planner::PlanOnLattice(c.map, c.start, c.goal).cost;
                   }});
  works.push_back({"verify, 1000 cells", [&] {
                     for (int i = 0; i < kWalks; ++i) {
                       sum += WalkRoute(c.map, plan.waypoints).cost;
                     }
                   }});
  works.push_back(
      {"shortcut", [&] {
         sum +=
             advisor::RefineByShortcut({c.map, plan.waypoints, plan.cost}).cost;
       }});
  works.push_back({"baseline, search, verify", [&] {
                     const planner::LatticePlan p =
                         planner::PlanOnLattice(c.map, c.start, c.goal);
                     const SearchResult found = NativeSearch(
                         c.map, c.start, c.goal, {.upper_bound = p.cost});
                     sum += WalkRoute(c.map, found.cells).cost;
                   }});
  std::vector<TimedSeries> once;
  TimeInterleaved(works, kRounds, once);
  for (TimedSeries& s : once) {
    if (s.name == "verify, 1000 cells") {
      s.microseconds[0] *= 1000.0 / (kWalks * static_cast<double>(walk.steps));
    }
    const auto same = std::find_if(series.begin(), series.end(),
                                   [&](const TimedSeries& other) {
                                     return other.name == s.name;
                                   });
    if (same == series.end()) {
      series.push_back(s);
    } else {
      same->microseconds.push_back(s.microseconds[0]);
    }
  }
  TERRA_REQUIRE(std::isfinite(sum));
}

// Per megabyte of map ids (one byte a cell).
void TimeBytes(const Case& c, std::vector<TimedSeries>& series) {
  const double megabytes = static_cast<double>(c.map.ids().size()) * 1e-6;
  const TileGrid grid{c.map.width(), c.map.height()};
  std::vector<std::vector<std::uint8_t>> tiles;
  for (int i = 0; i < grid.count(); ++i) {
    tiles.push_back(ExtractTile(c.map.ids(), grid, i));
  }
  std::size_t used = 0;
  std::vector<TimedSeries> once;
  TimeInterleaved({{"digest, 1 MB",
                    [&] {
                      used += TileDigests(c.map.ids(), grid).size();
                    }},
                   {"compress tiles, 1 MB",
                    [&] {
                      for (const auto& tile : tiles)
                        used += bus::CompressTile(tile).size();
                    }}},
                  kRounds, once);
  TERRA_REQUIRE(used > 0);
  for (const TimedSeries& s : once) {
    series.push_back({s.name, {s.microseconds[0] / megabytes}});
  }
}

void Print(int side, Subset subset, const std::vector<TimedSeries>& series,
           std::ofstream& csv) {
  const double unit = series.front().Quantile(0.5);
  const double unit_p95 = series.front().Quantile(0.95);
  const std::string name(SubsetName(subset));
  std::printf("\n%d x %d, %s, %zu maps%*s median us    p95 us   ratio   p95\n",
              side, side, name.c_str(), series.front().microseconds.size(), 6,
              "");
  for (const TimedSeries& s : series) {
    const double median = s.Quantile(0.5);
    const double p95 = s.Quantile(0.95);
    std::printf("  %-32s %10.1f %10.1f %7.2f %6.2f\n", s.name.c_str(), median,
                p95, median / unit, p95 / unit_p95);
    csv << side << ',' << name << ",\"" << s.name << "\"," << median << ','
        << p95 << ',' << median / unit << ',' << p95 / unit_p95 << '\n';
  }
  std::fflush(stdout);
}

int Run(const char* path, int maps) {
  std::ofstream csv(path);
  csv << "side,subset,work,median_us,p95_us,ratio,p95_ratio\n";
  for (const int scale : {1, 2, 4, 8}) {
    for (const Subset subset : {Subset::kEasy, Subset::kHard}) {
      std::vector<TimedSeries> series;
      for (int i = 0; i < std::max(maps / (scale * scale), 3); ++i) {
        const Case c = MakeCase(subset, i, scale);
        TimeSearches(c, series);
        if (scale == 1) TimeChain(c, series);
        if (scale == 8 && i == 0) TimeBytes(c, series);
      }
      Print(500 * scale, subset, series, csv);
    }
  }
  csv.flush();
  return csv ? 0 : 1;
}

}  // namespace
}  // namespace terra::benchmark

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: terra-speed OUT.csv [MAPS]\n");
    return 2;
  }
  return terra::benchmark::Run(argv[1], argc == 3 ? std::atoi(argv[2]) : 50);
}
