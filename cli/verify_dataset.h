#pragma once

#include <string>

#include "terrain/map.h"

namespace CLI {
class App;
}

namespace terra::cli {

/// The second form of `terra verify`: many routes on the cases of a dataset.
struct VerifyDatasetArguments {
  std::string dataset;
  std::string routes;  ///< CSV: case_id, k, route.
  std::string out;     ///< CSV: case_id, k, code, cost.
  UnknownGround unknown;
};

void AddVerifyDatasetOptions(CLI::App& command,
                             VerifyDatasetArguments& arguments);

/// Checks every route and writes the verdicts in the order of the routes; code
/// `feasible` or what failed, cost `inf` then. Returns the exit code.
int RunVerifyDataset(const VerifyDatasetArguments& arguments,
                     const CostModel& model);

}  // namespace terra::cli
