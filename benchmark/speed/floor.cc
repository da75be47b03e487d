#include "benchmark/speed/floor.h"

#include <algorithm>
#include <cstddef>

namespace terra::benchmark {
namespace {

#if defined(__x86_64__)
[[gnu::target_clones("arch=x86-64-v4", "avx2", "default")]]
#endif
void RelaxRow(const std::uint32_t* above, const std::uint32_t* weights,
              std::uint32_t* row, int width) {
  for (int x = 1; x + 1 < width; ++x) {
    const std::uint32_t diagonal = std::min(above[x - 1], above[x + 1]);
    const std::uint32_t key = std::min(above[x], diagonal + weights[x] / 2);
    row[x] = std::min(row[x], key + weights[x]);
  }
}

}  // namespace

RelaxOnce::RelaxOnce(const TerrainMap& map)
    : stride_(map.cost_grid().stride()),
      rows_(map.height() + 2),
      weights_(map.cost_grid().size()),
      keys_(map.cost_grid().size()) {
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    weights_[i] = map.cost_grid().data()[i] & CostGrid::kCodeMask;
  }
}

void RelaxOnce::Run() {
  std::fill(keys_.begin(), keys_.end(), 1U << 30);
  for (int y = 1; y < rows_; ++y) {
    std::uint32_t* row = keys_.data() + std::ptrdiff_t{y} * stride_;
    RelaxRow(row - stride_, weights_.data() + std::ptrdiff_t{y} * stride_, row,
             stride_);
  }
}

}  // namespace terra::benchmark
