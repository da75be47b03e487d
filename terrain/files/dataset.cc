#include "terrain/files/dataset.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "output/output_file.h"
#include "terrain/builtin_legends.h"
#include "terrain/files/case_reader.h"
#include "terrain/files/csv.h"
#include "terrain/files/legend_file.h"
#include "terrain/files/map_file.h"
#include "terrain/files/whole_file.h"

namespace terra {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxJsonBytes = std::size_t{1} << 20;

// Fills name, version, digest and json from dataset.json, where there is one.
Status ReadJson(const std::string& path, DatasetFolder& dataset) {
  Result<std::string> text = ReadWholeFile(path, kMaxJsonBytes);
  if (!text.ok()) {
    if (text.error().code == ErrorCode::kNotFound) return Done{};
    return text.error();
  }
  dataset.json = std::move(*text);
  const auto json = nlohmann::json::parse(dataset.json, nullptr, false);
  if (!json.is_object()) {
    return Error{ErrorCode::kInvalid,
                 path + ": not a JSON object, or not in UTF-8"};
  }
  for (const auto& [key, value] : {std::pair{"name", &dataset.name},
                                   std::pair{"version", &dataset.version},
                                   std::pair{"digest", &dataset.digest}}) {
    if (!json.contains(key)) continue;
    if (!json.at(key).is_string()) {
      return Error{ErrorCode::kInvalid,
                   path + ": '" + key + "' must be a text in quotes"};
    }
    *value = json.at(key).get<std::string>();
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

Result<DatasetFolder> OpenDataset(const std::string& folder,
                                  const UnknownGround& unknown) {
  const fs::path root(folder);
  const std::string legend_path = (root / "legend.csv").string();
  Result<Legend> legend = fs::exists(legend_path)
                              ? ReadLegend(legend_path)
                              : Result<Legend>(MultiTerraPathLegend());
  if (!legend.ok()) return legend.error();
  DatasetFolder dataset{folder, "", "", "", "", *std::move(legend), unknown};
  const Status json = ReadJson((root / "dataset.json").string(), dataset);
  if (!json.ok()) return json.error();
  return dataset;
}

Result<Dataset> ReadDataset(const std::string& folder,
                            const UnknownGround& unknown) {
  Result<DatasetFolder> opened = OpenDataset(folder, unknown);
  if (!opened.ok()) return opened.error();
  Dataset dataset{*std::move(opened), {}};
  const Status read = CheckCases(folder, [&](DatasetCase c) {
    dataset.cases.push_back(std::move(c));
  });
  if (!read.ok()) return read.error();
  return dataset;
}

MapFileOptions OptionsOfMaps(const DatasetFolder& dataset,
                             const CostModel& model) {
  const std::string legend_path =
      (fs::path(dataset.folder) / "legend.csv").string();
  return {fs::exists(legend_path) ? legend_path : "multiterrapath", model,
          dataset.unknown};
}

Result<TerrainMap> ReadCaseMap(const DatasetFolder& dataset,
                               const DatasetCase& dataset_case,
                               const CostModel& model) {
  Result<MapFile> file =
      ReadMap((fs::path(dataset.folder) / dataset_case.map).string(),
              OptionsOfMaps(dataset, model));
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
