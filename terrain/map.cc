#include "terrain/map.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace terra {
namespace {

// Returns, for each cell, the distance to the nearest blocked cell of its
// column, at most `limit` + 1. One pass down and one up.
Eigen::Array<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
ColumnDistances(const ByteRaster& classes, int limit) {
  Eigen::Array<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> distance(
      classes.rows(), classes.cols());
  Eigen::Array<int, 1, Eigen::Dynamic> running =
      Eigen::Array<int, 1, Eigen::Dynamic>::Constant(classes.cols(), limit + 1);
  for (Eigen::Index y = 0; y < classes.rows(); ++y) {
    running = (classes.row(y) == 0).select(0, (running + 1).min(limit + 1));
    distance.row(y) = running;
  }
  running.setConstant(limit + 1);
  for (Eigen::Index y = classes.rows() - 1; y >= 0; --y) {
    running = (running + 1).min(distance.row(y));
    distance.row(y) = running;
  }
  return distance;
}

// Blocks every cell within `clearance` of an impassable one: a blocked cell at
// column distance d covers the run of half-width sqrt(clearance^2 - d^2).
void ApplyClearance(ByteRaster& classes, int clearance) {
  if (clearance == 0) {
    return;
  }
  const auto distance = ColumnDistances(classes, clearance);
  std::vector<int> half_width(static_cast<std::size_t>(clearance) + 1);
  for (int d = 0; d <= clearance; ++d) {
    int w = static_cast<int>(
        std::sqrt(double(clearance) * clearance - double(d) * d));
    while ((w + 1) * (w + 1) + d * d <= clearance * clearance) ++w;
    while (w * w + d * d > clearance * clearance) --w;
    half_width[static_cast<std::size_t>(d)] = w;
  }
  const auto width = static_cast<int>(classes.cols());
  std::vector<int> cover(static_cast<std::size_t>(width) + 1);
  for (Eigen::Index y = 0; y < classes.rows(); ++y) {
    std::fill(cover.begin(), cover.end(), 0);
    for (int x = 0; x < width; ++x) {
      const int d = distance(y, x);
      if (d <= clearance) {
        const int w = half_width[static_cast<std::size_t>(d)];
        ++cover[static_cast<std::size_t>(std::max(0, x - w))];
        --cover[static_cast<std::size_t>(std::min(width - 1, x + w) + 1)];
      }
    }
    int open = 0;
    for (int x = 0; x < width; ++x) {
      open += cover[static_cast<std::size_t>(x)];
      if (open > 0) {
        classes(y, x) = 0;
      }
    }
  }
}

}  // namespace

Result<TerrainMap> TerrainMap::Create(ByteRaster ids, Legend legend,
                                      CostModel model) {
  if (ids.rows() < 1 || ids.cols() < 1 || ids.rows() > kMaxSide ||
      ids.cols() > kMaxSide) {
    return Error{ErrorCode::kUnsupported,
                 "a map is 1 to 8192 cells a side, this one is " +
                     std::to_string(ids.cols()) + " x " +
                     std::to_string(ids.rows())};
  }
  if (model.clearance_cells < 0 || model.clearance_cells > kMaxClearance) {
    return Error{ErrorCode::kInvalid,
                 "clearance is 0 to 1024 cells, not " +
                     std::to_string(model.clearance_cells)};
  }
  std::array<bool, 256> known{};
  for (const Terrain& terrain : legend.terrains()) {
    known[static_cast<std::size_t>(terrain.id)] = true;
  }
  const std::uint8_t* begin = ids.data();
  const std::uint8_t* end = begin + ids.size();
  const std::uint8_t* unknown =
      std::find_if(begin, end, [&known](std::uint8_t id) {
        return !known[id];
      });
  if (unknown != end) {
    const Eigen::Index index = unknown - begin;
    return Error{ErrorCode::kInvalid,
                 "cell " +
                     ToString(Cell{static_cast<int>(index % ids.cols()),
                                   static_cast<int>(index / ids.cols())}) +
                     " has terrain id " + std::to_string(*unknown) +
                     ", which the legend does not have; give the map's own "
                     "legend, or correct the map"};
  }
  return TerrainMap(std::move(ids), std::move(legend), model);
}

TerrainMap::TerrainMap(ByteRaster ids, Legend legend, CostModel model)
    : ids_(std::move(ids)),
      legend_(std::move(legend)),
      model_(model),
      costs_(MakeCostTable(legend_)),
      classes_(MakeClasses()),
      cost_grid_(classes_, costs_) {}

ByteRaster TerrainMap::MakeClasses() const {
  ByteRaster classes(ids_.rows(), ids_.cols());
  std::transform(ids_.data(), ids_.data() + ids_.size(), classes.data(),
                 [this](std::uint8_t id) {
                   return costs_.class_of_id[id];
                 });
  ApplyClearance(classes, model_.clearance_cells);
  return classes;
}

}  // namespace terra
