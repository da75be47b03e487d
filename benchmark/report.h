#pragma once

#include <string>
#include <vector>

#include "benchmark/loaded_run.h"
#include "terrain/result.h"

namespace terra::benchmark {

struct ReportOptions {
  std::vector<std::string> runs;  ///< Run folders, or folders above them.
  /// Dataset folders, for pictures; those whose digest a run has are used.
  std::vector<std::string> datasets;
  /// Camera frames of RUGD, for pictures of frame above mask; empty = where
  /// the dataset says.
  std::string frames;
  std::string out;
  bool include_simulated = false;
};

/// Writes the whole report: tables/*.csv, *.md and *.tex, figures/*.svg and
/// *.png, and report.html, one file without any link that opens anywhere.
///
/// Every table takes the runs that can stand in it together; those that stand
/// in none have tables of their own at the end. Simulated runs stay out of the
/// paper's tables unless asked for.
Status WriteReport(const ReportOptions& options);

}  // namespace terra::benchmark
