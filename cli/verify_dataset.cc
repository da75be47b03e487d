#include "cli/verify_dataset.h"

#include <iostream>
#include <map>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/legend_notice.h"
#include "cli/map_arguments.h"
#include "cli/output.h"
#include "output/output_file.h"
#include "terrain/files/csv.h"
#include "terrain/files/dataset.h"
#include "terrain/route_text.h"
#include "verifier/verify.h"

namespace terra::cli {
namespace {

using verifier::Code;
using verifier::RouteCheck;

// Rows of the routes file by the map they lie on, so that each map is read
// once and one at a time.
struct Work {
  const DatasetCase* dataset_case = nullptr;
  std::size_t row = 0;
};
using WorkByMap = std::map<std::string, std::vector<Work>>;

Result<WorkByMap> SortByMap(const Dataset& dataset, const CsvTable& routes,
                            const std::string& name) {
  const auto id_column = static_cast<std::size_t>(routes.Column("case_id"));
  const IdIndex index = IndexOf(dataset.cases);
  WorkByMap work;
  for (std::size_t row = 0; row < routes.rows.size(); ++row) {
    const std::string& id = routes.rows[row].fields[id_column];
    const std::optional<std::size_t> place = index.Find(id);
    if (!place) {
      return Error{ErrorCode::kInvalid,
                   name + ":" + std::to_string(routes.rows[row].line) +
                       ": the dataset has no case '" + id + "'"};
    }
    const DatasetCase& found = dataset.cases[*place];
    work[found.map].push_back({&found, row});
  }
  return work;
}

RouteCheck CheckText(const TerrainMap& map, const DatasetCase& dataset_case,
                     const std::string& text) {
  const Result<Route> route = ParseRoute(text);
  if (!route.ok()) {
    RouteCheck failed;
    failed.code = Code::kParseError;
    return failed;
  }
  return verifier::CheckRoute(map, *route, dataset_case.start,
                              dataset_case.goal);
}

Result<std::vector<RouteCheck>> CheckAll(const Dataset& dataset,
                                         const CsvTable& routes,
                                         const WorkByMap& work_by_map,
                                         const CostModel& model) {
  const auto route_column = static_cast<std::size_t>(routes.Column("route"));
  std::vector<RouteCheck> checks(routes.rows.size());
  for (const auto& [path, work] : work_by_map) {
    const Result<TerrainMap> map =
        ReadCaseMap(dataset, *work.front().dataset_case, model);
    if (!map.ok()) return map.error();
    for (const auto& [dataset_case, row] : work) {
      checks[row] =
          CheckText(*map, *dataset_case, routes.rows[row].fields[route_column]);
    }
  }
  return checks;
}

std::string VerdictsCsv(const CsvTable& routes,
                        const std::vector<RouteCheck>& checks) {
  const auto id_column = static_cast<std::size_t>(routes.Column("case_id"));
  const auto k_column = static_cast<std::size_t>(routes.Column("k"));
  std::string text = CsvLine({"case_id", "k", "code", "cost"});
  for (std::size_t row = 0; row < checks.size(); ++row) {
    const std::vector<std::string>& fields = routes.rows[row].fields;
    text += CsvLine({fields[id_column], fields[k_column],
                     std::string(verifier::CodeName(checks[row].code)),
                     FormatNumber(checks[row].cost)});
  }
  return text;
}

Status VerifyDataset(const VerifyDatasetArguments& arguments,
                     const CostModel& model) {
  const Result<Dataset> dataset =
      ReadDataset(arguments.dataset, arguments.unknown);
  if (!dataset.ok()) return dataset.error();
  NoteHowMapsAreRead(*dataset);
  const Result<CsvTable> routes =
      ReadCsv(arguments.routes, {"case_id", "k", "route"});
  if (!routes.ok()) return routes.error();
  const Result<WorkByMap> work = SortByMap(*dataset, *routes, arguments.routes);
  if (!work.ok()) return work.error();
  const Result<std::vector<RouteCheck>> checks =
      CheckAll(*dataset, *routes, *work, model);
  if (!checks.ok()) return checks.error();
  return WriteWholeFile(arguments.out, VerdictsCsv(*routes, *checks));
}

}  // namespace

void AddVerifyDatasetOptions(CLI::App& command,
                             VerifyDatasetArguments& arguments) {
  command.add_option("--dataset", arguments.dataset, "Folder with cases.csv")
      ->required()
      ->type_name("DIR");
  command.add_option("--routes", arguments.routes, "CSV: case_id,k,route")
      ->required()
      ->type_name("R.csv");
  command
      .add_option("--out", arguments.out, "CSV to write: case_id,k,code,cost")
      ->required()
      ->type_name("V.csv");
}

int RunVerifyDataset(const VerifyDatasetArguments& arguments,
                     const CostModel& model) {
  const Status done = VerifyDataset(arguments, model);
  return done.ok() ? kDone : Fail(done.error());
}

}  // namespace terra::cli
