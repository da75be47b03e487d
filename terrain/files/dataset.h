#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "terrain/cell.h"
#include "terrain/files/id_index.h"
#include "terrain/files/map_file.h"
#include "terrain/legend.h"
#include "terrain/map.h"
#include "terrain/result.h"

namespace terra {

/// The columns of cases.csv that every dataset has, and the group.
inline constexpr std::array<std::string_view, 7> kCaseColumns = {
    "case_id", "map", "start_x", "start_y", "goal_x", "goal_y", "group"};

/// One start and goal on one map of a dataset.
struct DatasetCase {
  std::string case_id;
  std::string map;  ///< Path relative to the dataset's folder.
  Cell start;
  Cell goal;
  std::string group;  ///< Empty where cases.csv has no such column.
  /// The other columns of cases.csv (RUGD: sequence), by name.
  std::map<std::string, std::string> extra;
};

/// A folder with cases.csv, dataset.json, maps and, unless the maps are of the
/// multiterrapath legend, legend.csv: all but its cases, of which there may be
/// any number (case_reader.h reads them one by one).
struct DatasetFolder {
  std::string folder;
  std::string name;     ///< dataset.json "name".
  std::string version;  ///< dataset.json "version"; empty where it has none.
  std::string digest;   ///< dataset.json "digest"; empty where it has none.
  std::string json;     ///< dataset.json as it stands.
  Legend legend;
  UnknownGround unknown = {};  ///< Of its ROS maps.
};

/// The same with its cases.
struct Dataset : DatasetFolder {
  std::vector<DatasetCase> cases;  ///< In order of cases.csv.

  /// Returns the case of an id, or nullptr. Takes time; for many ids there is
  /// IndexOf.
  const DatasetCase* Find(const std::string& case_id) const;
};

/// The index of cases by their ids. The list must stay as it is.
IdIndex IndexOf(const std::vector<DatasetCase>& cases);

/// Reads legend.csv and dataset.json. A missing dataset.json leaves name,
/// version, digest and json empty. Errors: name the file and line.
Result<DatasetFolder> OpenDataset(const std::string& folder,
                                  const UnknownGround& unknown = {});

/// Reads the folder's tables, no maps. Errors: those of OpenDataset and
/// CheckCases.
Result<Dataset> ReadDataset(const std::string& folder,
                            const UnknownGround& unknown = {});

/// How the maps of a dataset are read.
MapFileOptions OptionsOfMaps(const DatasetFolder& dataset,
                             const CostModel& model = {});

/// Reads the map of a case.
Result<TerrainMap> ReadCaseMap(const DatasetFolder& dataset,
                               const DatasetCase& dataset_case,
                               const CostModel& model = {});

/// Writes cases.csv (columns case_id, map, start_x, start_y, goal_x, goal_y,
/// group, then the extra ones of the first case).
Status WriteCases(const std::vector<DatasetCase>& cases,
                  const std::string& path);

}  // namespace terra
