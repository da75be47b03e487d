#include "terrain/files/dataset.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "terrain/builtin_legends.h"
#include "terrain/files/legend_file.h"
#include "terrain/files/map_file.h"
#include "terrain/files/whole_file.h"

namespace terra {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 7> kCaseColumns = {
    "case_id", "map", "start_x", "start_y", "goal_x", "goal_y", "group"};
constexpr std::size_t kMaxJsonBytes = std::size_t{1} << 20;

bool IsExtraColumn(const std::string& column) {
  return std::find(kCaseColumns.begin(), kCaseColumns.end(), column) ==
         kCaseColumns.end();
}

// A dataset may come from elsewhere: its maps must lie in its own folder.
bool StaysInside(const std::string& relative) {
  const fs::path path(relative);
  return !relative.empty() && path.is_relative() &&
         std::find(path.begin(), path.end(), "..") == path.end();
}

// Takes the row's texts: a table may have a million rows.
Result<DatasetCase> ParseCase(const CsvTable& table, CsvRow row,
                              const std::string& path) {
  const auto fail = [&](const std::string& what) {
    return Error{ErrorCode::kInvalid,
                 path + ":" + std::to_string(row.line) + ": " + what};
  };
  DatasetCase result;
  std::array<int*, 4> numbers = {&result.start.x, &result.start.y,
                                 &result.goal.x, &result.goal.y};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::string_view column = kCaseColumns[i + 2];
    const Result<int> value = ParseInteger(
        row.fields[static_cast<std::size_t>(table.Column(column))]);
    if (!value.ok()) {
      return fail(std::string(column) + ": " + value.error().message);
    }
    *numbers[i] = *value;
  }
  for (std::size_t i = 0; i < row.fields.size(); ++i) {
    const std::string& column = table.header[i];
    std::string& field = row.fields[i];
    if (column == "case_id") {
      result.case_id = std::move(field);
    } else if (column == "map") {
      result.map = std::move(field);
    } else if (column == "group") {
      result.group = std::move(field);
    } else if (IsExtraColumn(column)) {
      result.extra[column] = std::move(field);
    }
  }
  if (result.case_id.empty()) return fail("empty case_id");
  if (!StaysInside(result.map)) {
    return fail("map '" + result.map +
                "' must be a path inside the dataset's folder");
  }
  return result;
}

Result<std::vector<DatasetCase>> ReadCases(const std::string& path) {
  std::vector<DatasetCase> cases;
  std::vector<int> lines;
  const Status read = ReadCsvRows(
      path, {"case_id", "map", "start_x", "start_y", "goal_x", "goal_y"},
      [&](const CsvTable& table, CsvRow row) -> Status {
        lines.push_back(row.line);
        Result<DatasetCase> one = ParseCase(table, std::move(row), path);
        if (!one.ok()) return one.error();
        cases.push_back(*std::move(one));
        return Done{};
      });
  if (!read.ok()) return read.error();
  const std::optional<std::size_t> twice = IndexOf(cases).FirstDouble();
  if (twice) {
    return Error{ErrorCode::kInvalid,
                 path + ":" + std::to_string(lines[*twice]) + ": case_id '" +
                     cases[*twice].case_id + "' comes twice"};
  }
  return cases;
}

// Fills name, version, digest and json from dataset.json, where there is one.
Status ReadJson(const std::string& path, Dataset& dataset) {
  Result<std::string> text = ReadWholeFile(path, kMaxJsonBytes);
  if (!text.ok()) {
    if (text.error().code == ErrorCode::kNotFound) return Done{};
    return text.error();
  }
  dataset.json = std::move(*text);
  try {
    const auto json = nlohmann::json::parse(dataset.json);
    dataset.name = json.value("name", "");
    dataset.version = json.value("version", "");
    dataset.digest = json.value("digest", "");
  } catch (const nlohmann::json::exception& error) {
    return Error{ErrorCode::kInvalid, path + ": " + error.what()};
  }
  return Done{};
}

}  // namespace

const DatasetCase* Dataset::Find(const std::string& case_id) const {
  const auto found =
      std::find_if(cases.begin(), cases.end(), [&](const DatasetCase& c) {
        return c.case_id == case_id;
      });
  return found == cases.end() ? nullptr : &*found;
}

IdIndex IndexOf(const std::vector<DatasetCase>& cases) {
  std::vector<const std::string*> ids;
  ids.reserve(cases.size());
  for (const DatasetCase& c : cases) ids.push_back(&c.case_id);
  return IdIndex(std::move(ids));
}

Result<Dataset> ReadDataset(const std::string& folder) {
  const fs::path root(folder);
  const std::string legend_path = (root / "legend.csv").string();
  Result<Legend> legend = fs::exists(legend_path)
                              ? ReadLegend(legend_path)
                              : Result<Legend>(MultiTerraPathLegend());
  if (!legend.ok()) return legend.error();
  Result<std::vector<DatasetCase>> cases =
      ReadCases((root / "cases.csv").string());
  if (!cases.ok()) return cases.error();
  Dataset dataset{folder,           "", "", "", "", std::move(*legend),
                  std::move(*cases)};
  const Status json = ReadJson((root / "dataset.json").string(), dataset);
  if (!json.ok()) return json.error();
  return dataset;
}

Result<TerrainMap> ReadCaseMap(const Dataset& dataset,
                               const DatasetCase& dataset_case,
                               const CostModel& model) {
  const fs::path root(dataset.folder);
  const std::string legend_path = (root / "legend.csv").string();
  MapFileOptions options;
  options.legend = fs::exists(legend_path) ? legend_path : "multiterrapath";
  options.cost_model = model;
  Result<MapFile> file = ReadMap((root / dataset_case.map).string(), options);
  if (!file.ok()) return file.error();
  return std::move(file->map);
}

Status WriteCases(const std::vector<DatasetCase>& cases,
                  const std::string& path) {
  std::vector<std::string> header(kCaseColumns.begin(), kCaseColumns.end());
  if (!cases.empty()) {
    for (const auto& [column, value] : cases.front().extra) {
      header.push_back(column);
    }
  }
  std::string text = CsvLine(header);
  for (const DatasetCase& one : cases) {
    std::vector<std::string> fields = {one.case_id,
                                       one.map,
                                       std::to_string(one.start.x),
                                       std::to_string(one.start.y),
                                       std::to_string(one.goal.x),
                                       std::to_string(one.goal.y),
                                       one.group};
    for (std::size_t i = kCaseColumns.size(); i < header.size(); ++i) {
      const auto found = one.extra.find(header[i]);
      fields.push_back(found == one.extra.end() ? "" : found->second);
    }
    text += CsvLine(fields);
  }
  return WriteWholeFile(path, text);
}

}  // namespace terra
