#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "benchmark/speed/floor.h"
#include "benchmark/speed/peers.h"
#include "benchmark/speed/textbook_peer.h"
#include "benchmark/speed/works.h"
#include "planner/coarse_lattice.h"
#include "terrain/native_search.h"
#include "terrain/require.h"
#include "terrain/search_steps.h"

namespace terra::benchmark {
namespace {

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

// Every search must find the same cost, or its time says nothing.
void RequireCost(double cost, double want) {
  TERRA_REQUIRE(cost == want || std::abs(cost - want) <= 1e-9 * want);
}

// Collects works that answer one query.
class SearchWorks {
 public:
  explicit SearchWorks(const SpeedCase& c)
      : case_(c),
        want_(searcher_.Search(c.map, c.start, c.goal).cost),
        cells_(static_cast<double>(c.map.ids().size())) {}

  void AddNative(const std::string& name, const NativeSearchOptions& options) {
    works.push_back(
        {.name = name,
         .run =
             [this, options] {
               RequireCost(
                   searcher_.Search(case_.map, case_.start, case_.goal, options)
                       .cost,
                   want_);
             },
         .amount = cells_});
  }

  // What planner::FindOptimum does where no route is known, in kept memory: the
  // lattice is part of the time.
  void AddAfterLattice(const std::string& name, InstructionSet set) {
    works.push_back(
        {.name = name,
         .run =
             [this, set] {
               const double bound =
                   planner::PlanOnLattice(case_.map, case_.start, case_.goal)
                       .cost;
               RequireCost(
                   searcher_
                       .Search(case_.map, case_.start, case_.goal,
                               {.upper_bound = bound, .instructions = set})
                       .cost,
                   want_);
             },
         .amount = cells_});
  }

  void AddPeer(const std::string& name, std::unique_ptr<Peer> peer) {
    const int width = case_.map.width();
    const int start = case_.start.y * width + case_.start.x;
    const int goal = case_.goal.y * width + case_.goal.x;
    works.push_back({.name = name,
                     .run =
                         [this, start, goal, p = peer.get()] {
                           RequireCost(p->Search(start, goal), want_);
                         },
                     .amount = cells_});
    peers_.push_back(std::move(peer));
  }

  std::vector<TimedWork> works;

 private:
  const SpeedCase& case_;
  NativeSearcher searcher_;
  double want_;
  double cells_;
  std::vector<std::unique_ptr<Peer>> peers_;
};

const char* NameOf(InstructionSet set) {
  switch (set) {
    case InstructionSet::kAvx512:
      return "AVX-512";
    case InstructionSet::kAvx2:
      return "AVX2";
    case InstructionSet::kPortable:
      break;
  }
  return "portable";
}

}  // namespace

std::vector<TimedSample> TimeSearches(const SpeedCase& c, int rounds) {
  SearchWorks all(c);
  const double baseline = planner::PlanOnLattice(c.map, c.start, c.goal).cost;
  for (const InstructionSet set :
       {InstructionSet::kPortable, InstructionSet::kAvx2,
        InstructionSet::kAvx512}) {
    if (set > BestInstructionSet()) continue;
    const std::string name = std::string("search, ") + NameOf(set);
    all.AddNative(name, {.instructions = set});
    all.AddNative(name + ", bounded",
                  {.upper_bound = baseline, .instructions = set});
    all.AddAfterLattice("lattice, " + name, set);
  }
  RelaxOnce floor(c.map);
  all.works.push_back({.name = "floor",
                       .run =
                           [&floor] {
                             floor.Run();
                           },
                       .amount = static_cast<double>(c.map.ids().size())});
  all.AddPeer("textbook A*", MakeTextbookPeer(c.map));
  const ArcGraph arcs = MakeArcs(c.map);
  all.AddPeer("Boost.Graph A*", MakeBoostPeer(arcs));
  all.AddPeer("LEMON A*", MakeLemonPeer(arcs));
  return TimeInterleaved(all.works, rounds);
}

std::vector<TimedSample> TimeWorstCase(const SpeedCase& c, int rounds) {
  SearchWorks all(c);
  all.AddNative("search", {});
  all.AddNative("search, portable",
                {.instructions = InstructionSet::kPortable});
  all.AddPeer("textbook A*", MakeTextbookPeer(c.map));
  return TimeInterleaved(all.works, rounds);
}

}  // namespace terra::benchmark
