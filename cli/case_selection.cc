#include "cli/case_selection.h"

#include <optional>
#include <sstream>

#include <CLI/CLI.hpp>

#include "benchmark/run.h"
#include "terrain/files/csv.h"
#include "terrain/files/whole_file.h"

namespace terra::cli {
namespace {

constexpr std::size_t kMaxCaseListBytes = std::size_t{1} << 28;

}  // namespace

void AddCasesOption(CLI::App& command, std::string& cases) {
  command
      .add_option("--cases", cases,
                  "The first N cases of each group, or a file with an id a "
                  "line (default: all)")
      ->type_name("FILE|N");
}

Result<std::vector<std::string>> SelectCases(const Dataset& dataset,
                                             const std::string& text) {
  if (text.empty()) return std::vector<std::string>{};
  const Result<int> number = ParseInteger(text);
  if (number.ok() && *number < 1) {
    return Error{ErrorCode::kInvalid,
                 "--cases " + text + ": at least one case of each group"};
  }
  if (number.ok()) return benchmark::FirstOfEachGroup(dataset, *number);
  const Result<std::string> file = ReadWholeFile(text, kMaxCaseListBytes);
  if (!file.ok()) return file.error();
  std::vector<std::string> ids;
  const IdIndex index = IndexOf(dataset.cases);
  std::istringstream lines(*file);
  for (std::string id; lines >> id;) {
    if (!index.Find(id)) {
      return Error{ErrorCode::kInvalid,
                   text + ": the dataset has no case '" + id + "'"};
    }
    ids.push_back(id);
  }
  if (ids.empty()) {
    return Error{ErrorCode::kInvalid, text + ": names no case"};
  }
  const std::optional<std::size_t> twice = IndexOf(ids).FirstDouble();
  if (twice) {
    return Error{ErrorCode::kInvalid,
                 text + ": names '" + ids[*twice] + "' twice"};
  }
  return ids;
}

}  // namespace terra::cli
