#pragma once

#include <cstdint>

#include "terrain/cell.h"
#include "terrain/cost_grid.h"
#include "terrain/cost_table.h"
#include "terrain/legend.h"
#include "terrain/raster.h"
#include "terrain/result.h"

namespace terra {

/// How cells may be crossed, beyond their terrain.
struct CostModel {
  /// May a diagonal step pass between two blocked cells? The paper's rule is
  /// yes. When no, a diagonal step needs both orthogonal neighbours passable.
  bool corner_cutting = true;
  /// A cell is blocked when an impassable one lies within
  /// dx^2 + dy^2 <= clearance_cells^2. The map's edge does not count.
  int clearance_cells = 0;

  friend bool operator==(const CostModel&, const CostModel&) = default;
};

/// A terrain map with its legend and cost model: the ground truth that planner,
/// advisors and verifier share. Immutable; threads may share it.
///
/// Source: paper, Problem Formulation.
class TerrainMap {
 public:
  static constexpr int kMaxSide = 8192;
  static constexpr int kMaxClearance = 1024;

  /// Errors: empty or larger than kMaxSide a side; an id that the legend does
  /// not have (named with its cell); clearance outside 0 to kMaxClearance.
  static Result<TerrainMap> Create(ByteRaster ids, Legend legend,
                                   CostModel model = {});

  int width() const { return static_cast<int>(ids_.cols()); }
  int height() const { return static_cast<int>(ids_.rows()); }
  bool Contains(Cell c) const {
    return c.x >= 0 && c.y >= 0 && c.x < width() && c.y < height();
  }

  const ByteRaster& ids() const { return ids_; }
  const Legend& legend() const { return legend_; }
  const CostModel& cost_model() const { return model_; }

  /// Cost class of each cell, clearance included; 0 = blocked.
  const ByteRaster& classes() const { return classes_; }
  const CostTable& costs() const { return costs_; }
  /// The same costs with a blocked border, for searches on all cells.
  const CostGrid& cost_grid() const { return cost_grid_; }

  /// The cell must be inside the map.
  bool Passable(Cell c) const { return classes_(c.y, c.x) != 0; }
  double Cost(Cell c) const { return costs_.cost[classes_(c.y, c.x)]; }

 private:
  TerrainMap(ByteRaster ids, Legend legend, CostModel model);
  ByteRaster MakeClasses() const;

  ByteRaster ids_;
  Legend legend_;
  CostModel model_;
  CostTable costs_;
  ByteRaster classes_;
  CostGrid cost_grid_;
};

}  // namespace terra
