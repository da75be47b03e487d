#include "benchmark/named_tables.h"

#include <algorithm>

#include "benchmark/detail_tables.h"
#include "benchmark/paper_tables.h"
#include "benchmark/switch_tables.h"
#include "terrain/require.h"

namespace terra::benchmark {
namespace {

using Runs = std::vector<LoadedRun>;

template <typename Make>
auto OfGroup(Make make, const std::string& group) {
  return [make, group](const Runs& runs) -> Result<Table> {
    return make(runs, group);
  };
}

}  // namespace

const std::vector<NamedTable>& NamedTables() {
  static const std::vector<NamedTable> kTables = {
      {"comparison-easy",
       &Selection::comparison,
       OfGroup(ComparisonTable, "easy"),
       {}},
      {"comparison-hard",
       &Selection::comparison,
       OfGroup(ComparisonTable, "hard"),
       {}},
      {"proposals-easy",
       &Selection::comparison,
       OfGroup(ProposalTable, "easy"),
       {}},
      {"proposals-hard",
       &Selection::comparison,
       OfGroup(ProposalTable, "hard"),
       {}},
      {"paired-easy", &Selection::paired, OfGroup(PairedTable, "easy"), {}},
      {"paired-hard", &Selection::paired, OfGroup(PairedTable, "hard"), {}},
      {"oracle-gap", &Selection::gap, OracleGapTable, {Shared::kStride}},
      {"joints",
       &Selection::joints,
       JointsTable,
       {Shared::kJoints, Shared::kStride}},
      {"ablation", &Selection::ablation, AblationTable, {}},
      {"noise", &Selection::noise, NoiseTable, {}},
      {"latency", &Selection::latency, LatencyTable, {}},
      {"rugd", &Selection::rugd, RugdTable, {}},
      {"runs",
       &Selection::all,
       RunsTable,
       {Shared::kDataset, Shared::kCaseList, Shared::kStride, Shared::kJoints,
        Shared::kCostModel, Shared::kBaselines}},
  };
  return kTables;
}

const NamedTable& TableNamed(const std::string& name) {
  const auto found = std::find_if(NamedTables().begin(), NamedTables().end(),
                                  [&](const NamedTable& table) {
                                    return table.name == name;
                                  });
  TERRA_REQUIRE(found != NamedTables().end());
  return *found;
}

}  // namespace terra::benchmark
