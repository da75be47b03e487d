#include "benchmark/rugd_ends.h"

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "benchmark/integer_random.h"
#include "planner/coarse_lattice.h"

namespace terra::benchmark {
namespace {

// The components of passable cells, 8-connected: a label per cell, 0 = blocked.
using Labels =
    Eigen::Array<std::int32_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void FloodFill(const TerrainMap& map, Cell from, std::int32_t label,
               Labels& labels) {
  std::vector<Cell> open = {from};
  labels(from.y, from.x) = label;
  while (!open.empty()) {
    const Cell cell = open.back();
    open.pop_back();
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell next{cell.x + dx, cell.y + dy};
        if (!map.Contains(next) || !map.Passable(next) ||
            labels(next.y, next.x) != 0) {
          continue;
        }
        labels(next.y, next.x) = label;
        open.push_back(next);
      }
    }
  }
}

Labels LabelComponents(const TerrainMap& map) {
  Labels labels = Labels::Zero(map.height(), map.width());
  std::int32_t count = 0;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (map.Passable({x, y}) && labels(y, x) == 0) {
        FloodFill(map, {x, y}, ++count, labels);
      }
    }
  }
  return labels;
}

std::uint64_t FrameSeed(std::uint64_t seed, const std::string& name) {
  // FNV-1a over the name (Fowler, Noll, Vo), scrambled with the seed.
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : name) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return IntegerRandom::Mix(hash ^ IntegerRandom::Mix(seed));
}

bool FarEnough(Cell a, Cell b) {
  const std::int64_t dx = a.x - b.x;
  const std::int64_t dy = a.y - b.y;
  return dx * dx + dy * dy >= kRugdEndDistance * kRugdEndDistance;
}

bool HasLatticeRoute(const TerrainMap& map, Cell start, Cell goal) {
  planner::LatticeOptions options;
  options.stride = kRugdStride;
  return planner::PlanOnLattice(map, start, goal, options).found();
}

}  // namespace

RugdDraw DrawRugdEnds(const TerrainMap& map, std::uint64_t seed,
                      const std::string& frame_name) {
  const Labels labels = LabelComponents(map);
  std::vector<Cell> passable;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (labels(y, x) != 0) passable.push_back({x, y});
    }
  }
  if (passable.empty()) return {std::nullopt, "no passable cell"};
  IntegerRandom random(FrameSeed(seed, frame_name));
  const auto last = static_cast<int>(passable.size()) - 1;
  const auto draw = [&] {
    return passable[static_cast<std::size_t>(random.In(0, last))];
  };
  int apart = 0;
  int close = 0;
  for (int i = 0; i < kRugdDraws; ++i) {
    const Cell start = draw();
    const Cell goal = draw();
    if (labels(start.y, start.x) != labels(goal.y, goal.x)) {
      ++apart;
    } else if (!FarEnough(start, goal)) {
      ++close;
    } else if (HasLatticeRoute(map, start, goal)) {
      return {RugdEnds{start, goal}, ""};
    }
  }
  const int no_route = kRugdDraws - apart - close;
  return {std::nullopt,
          std::to_string(kRugdDraws) + " draws: " + std::to_string(apart) +
              " in different components, " + std::to_string(close) +
              " too close, " + std::to_string(no_route) +
              " without a lattice route"};
}

}  // namespace terra::benchmark
