#pragma once

#include "benchmark/map_generator.h"

namespace terra::benchmark {

/// A row of the paper's oracle-gap table, as printed. Percent.
struct PaperGap {
  int stride = 0;
  double gap_rate = 0;
  double mean_gap = 0;
  double mogr = 0;  ///< Of LLM-Advisor (GPT-5.5).
};

/// Pre: a stride of the table: 10, 20, 50 or 100.
PaperGap PaperGapOf(Subset subset, int stride);

}  // namespace terra::benchmark
