#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "benchmark/shapes.h"
#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::benchmark {

/// The paper's two map regimes.
enum class Subset { kEasy, kHard };

/// Returns "easy" or "hard".
std::string_view SubsetName(Subset subset);
std::optional<Subset> FindSubset(std::string_view name);

/// Raised with every change that alters a generated cell or end.
inline constexpr int kGeneratorVersion = 1;

/// What a map is drawn from. Units: cells.
struct MapParameters {
  int side = 500;
  IntRange polygons;
  StarRanges star;
  /// Easy: polygons keep this distance (measured along rays from the centre of
  /// the later one). Negative: they may overlap, the later one on top.
  int separation = -1;
  bool ribbon = false;
  IntRange ribbon_half_width;
  IntRange ribbon_amplitude;
  IntRange ribbon_angle;  ///< The wave's angle over the map, in 1/1024 turn.
  IntRange obstacles{1, 2};
  IntRange obstacle_short;
  IntRange obstacle_long;
  /// Obstacles keep this far from the map's edge, so that no way round is
  /// narrower than a lattice is wide.
  int obstacle_edge_distance = 0;
  int end_margin = 0;    ///< Of start and goal from the map's edge.
  int end_distance = 0;  ///< Least Euclidean distance of start and goal.
  /// A lattice route joins the ends at each of these.
  std::vector<int> strides{10, 20, 50, 100};
};

/// The parameters of multiterrapath-like v1, calibrated to the paper's table of
/// oracle gaps (docs/benchmark.md).
MapParameters CalibratedParameters(Subset subset);

/// What was drawn and thrown away on the way to a case.
struct Rejections {
  std::int64_t polygon_misplaced = 0;  ///< A polygon, drawn again.
  std::int64_t too_few_polygons = 0;   ///< The whole map.
  std::int64_t end_blocked = 0;        ///< Start and goal, drawn again.
  std::int64_t ends_too_close = 0;     ///< The same.
  std::int64_t no_lattice_route = 0;   ///< The same.
  std::int64_t no_ends_found = 0;      ///< The whole map.

  Rejections& operator+=(const Rejections& other);
  friend bool operator==(const Rejections&, const Rejections&) = default;
};

/// A map with a start and a goal in opposite halves (one left, one right).
struct GeneratedCase {
  TerrainMap map;
  Cell start;
  Cell goal;
  Rejections rejections;
};

/// Draws case `index` of a subset. A pure function of its arguments: the same
/// cells and ends on any machine, and independent of all other cases.
///
/// Pre:    parameters that admit a map; after 1,000 rejected maps it gives up
///         as for a caller's bug.
/// Source: the construction in the paper, Experimental Setup; shapes, sizes and
///         rejection rules are this project's, as the paper names none.
GeneratedCase GenerateCase(Subset subset, std::uint64_t seed, int index,
                           const MapParameters& parameters);

}  // namespace terra::benchmark
