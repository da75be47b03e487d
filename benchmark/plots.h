#pragma once

#include <string>
#include <vector>

#include "benchmark/loaded_run.h"

namespace terra::benchmark {

/// Plots as SVG that stands alone: no script, no font, no link. Colours come
/// from CSS variables with fallbacks, so they follow the report's theme.

/// A dot with its 95 % interval per method: FIR of one group.
std::string FirPlot(const std::vector<LoadedRun>& runs,
                    const std::string& group);

/// The same for MOGR.
std::string MogrPlot(const std::vector<LoadedRun>& runs,
                     const std::string& group);

/// Mean gap over the stride, both subsets, beside the paper's points.
std::string GapPlot(const std::vector<LoadedRun>& runs);

}  // namespace terra::benchmark
