#pragma once

#include <string>
#include <string_view>

#include "benchmark/map_generator.h"
#include "benchmark/table.h"

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

/// The rows that the paper prints for a table of that id, as a block of their
/// own. Columns that the paper does not have show "-".
/// Pre: "comparison-easy", "comparison-hard", "ablation", "rugd", "latency" or
/// "noise"; `columns` of this project's table.
TableBlock PaperBlock(std::string_view table_id,
                      const std::vector<TableColumn>& columns);

/// What every such block is headed with.
inline constexpr std::string_view kPaperHeading =
    "Paper, as printed; other maps, prompt and joints: not comparable number "
    "by number";

}  // namespace terra::benchmark
