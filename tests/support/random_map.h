#pragma once

#include <cstdint>
#include <random>

#include "terrain/map.h"

namespace terra::testing {

/// Seeded random numbers that are the same on every machine (no <random>
/// distributions, whose results are the library's business).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// Uniform in [low, high], up to a bias that no test can see.
  int Int(int low, int high) {
    const auto span = static_cast<std::uint64_t>(high - low) + 1;
    return low + static_cast<int>(engine_() % span);
  }
  bool OneIn(int n) { return Int(1, n) == 1; }

 private:
  std::mt19937_64 engine_;
};

enum class RandomMapKind { kNoise, kRectangles, kObstacles };

/// A random map of the multiterrapath legend: single-cell noise, a few
/// rectangles of terrain and obstacle, or ground with 30 % single obstacles.
TerrainMap RandomMap(Random& random, int width, int height, RandomMapKind kind,
                     CostModel model = {});

/// A random passable cell; the map must have one.
Cell RandomPassableCell(Random& random, const TerrainMap& map);

}  // namespace terra::testing
