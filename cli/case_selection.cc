#include "cli/case_selection.h"

#include <optional>
#include <sstream>

#include <CLI/CLI.hpp>

#include "terrain/files/csv.h"
#include "terrain/files/id_index.h"
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

Result<benchmark::CaseSelection> SelectCases(const std::string& text) {
  benchmark::CaseSelection selection;
  if (text.empty()) return selection;
  const Result<int> number = ParseInteger(text);
  if (number.ok() && *number < 1) {
    return Error{ErrorCode::kInvalid,
                 "--cases " + text + ": at least one case of each group"};
  }
  if (number.ok()) {
    selection.first_of_each_group = *number;
    return selection;
  }
  const Result<std::string> file = ReadWholeFile(text, kMaxCaseListBytes);
  if (!file.ok()) return file.error();
  std::istringstream lines(*file);
  for (std::string id; lines >> id;) selection.ids.push_back(id);
  if (selection.ids.empty()) {
    return Error{ErrorCode::kInvalid, text + ": names no case"};
  }
  const std::optional<std::size_t> twice = IndexOf(selection.ids).FirstDouble();
  if (twice) {
    return Error{ErrorCode::kInvalid,
                 text + ": names '" + selection.ids[*twice] + "' twice"};
  }
  return selection;
}

}  // namespace terra::cli
