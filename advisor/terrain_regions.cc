#include "advisor/terrain_regions.h"

#include <algorithm>
#include <numeric>

namespace terra::advisor {
namespace {

/// Successive cells of one cost class in a row.
struct Run {
  int y = 0;
  int first = 0;
  int last = 0;
  std::uint8_t cost_class = 0;
};

std::vector<Run> FindRuns(const ByteRaster& classes) {
  std::vector<Run> runs;
  const int width = static_cast<int>(classes.cols());
  for (int y = 0; y < static_cast<int>(classes.rows()); ++y) {
    const std::uint8_t* row = classes.data() + Eigen::Index{y} * width;
    for (int x = 0; x < width;) {
      const int first = x;
      while (x < width && row[x] == row[first]) ++x;
      runs.push_back({y, first, x - 1, row[first]});
    }
  }
  return runs;
}

/// Disjoint sets of run indices; the representative is the first in map order.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t Find(std::size_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }
  void Unite(std::size_t a, std::size_t b) {
    a = Find(a);
    b = Find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Unites each run with those of the row above that touch it, corners included.
Sets Connect(const std::vector<Run>& runs) {
  Sets sets(runs.size());
  std::size_t above = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    while (runs[above].y < runs[i].y - 1 ||
           (runs[above].y == runs[i].y - 1 &&
            runs[above].last < runs[i].first - 1)) {
      ++above;
    }
    for (std::size_t j = above; j < i && runs[j].y == runs[i].y - 1 &&
                                runs[j].first <= runs[i].last + 1;
         ++j) {
      if (runs[j].cost_class == runs[i].cost_class) sets.Unite(i, j);
    }
  }
  return sets;
}

}  // namespace

TerrainRegions FindRegions(const TerrainMap& map, std::int64_t above_cells,
                           std::size_t at_most) {
  const std::vector<Run> runs = FindRuns(map.classes());
  Sets sets = Connect(runs);
  std::vector<TerrainRegion> regions;
  std::vector<int> longest;
  std::vector<std::size_t> region_of(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Run& run = runs[i];
    const std::size_t first = sets.Find(i);
    if (first == i) {
      region_of[i] = regions.size();
      regions.push_back({map.costs().cost[run.cost_class],
                         0,
                         {run.first, run.y},
                         {run.last, run.y},
                         {}});
      longest.push_back(0);
    }
    const std::size_t at = region_of[first];
    TerrainRegion& region = regions[at];
    const int length = run.last - run.first + 1;
    region.cells += length;
    region.low.x = std::min(region.low.x, run.first);
    region.high.x = std::max(region.high.x, run.last);
    region.high.y = run.y;
    if (length > longest[at]) {
      longest[at] = length;
      region.inside = {run.first + length / 2, run.y};
    }
  }

  TerrainRegions found;
  std::stable_sort(regions.begin(), regions.end(),
                   [](const TerrainRegion& a, const TerrainRegion& b) {
                     return a.cells > b.cells;
                   });
  for (const TerrainRegion& region : regions) {
    if (region.cells > above_cells && found.large.size() < at_most) {
      found.large.push_back(region);
    } else {
      ++found.small_regions;
      found.small_cells += region.cells;
    }
  }
  return found;
}

}  // namespace terra::advisor
