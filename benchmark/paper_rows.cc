#include "benchmark/paper_rows.h"

#include <array>

#include "terrain/require.h"

namespace terra::benchmark {
namespace {

constexpr std::array<PaperGap, 4> kEasyGaps = {{{10, 78.00, 1.58, 12.73},
                                                {20, 84.00, 3.35, 19.96},
                                                {50, 88.00, 8.73, 35.33},
                                                {100, 92.00, 17.30, 49.16}}};
constexpr std::array<PaperGap, 4> kHardGaps = {{{10, 96.00, 2.53, 12.79},
                                                {20, 100.00, 4.51, 14.41},
                                                {50, 100.00, 11.39, 20.55},
                                                {100, 100.00, 20.75, 29.98}}};

}  // namespace

PaperGap PaperGapOf(Subset subset, int stride) {
  for (const PaperGap& row : subset == Subset::kEasy ? kEasyGaps : kHardGaps) {
    if (row.stride == stride) return row;
  }
  FailRequirement("a stride of the paper's table", __FILE__, __LINE__);
}

}  // namespace terra::benchmark
