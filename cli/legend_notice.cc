#include "cli/legend_notice.h"

#include <filesystem>
#include <iostream>
#include <optional>

#include "cli/map_arguments.h"
#include "terrain/files/ascii_case.h"
#include "terrain/files/case_reader.h"

namespace terra::cli {

namespace fs = std::filesystem;

void NoteHowMapsAreRead(const DatasetFolder& dataset) {
  Result<CaseReader> cases = CaseReader::Open(dataset.folder);
  if (!cases.ok()) return;  // What is wrong is said by who needs the cases.
  const Result<std::optional<DatasetCase>> first = cases->Next();
  if (!first.ok() || !first->has_value()) return;
  const std::string& map = (*first)->map;
  if (HasExtension(map, ".png")) return;
  if (HasExtension(map, ".yaml") || HasExtension(map, ".yml")) {
    const Result<MapFile> file = ReadMap(
        (fs::path(dataset.folder) / map).string(), OptionsOfMaps(dataset));
    if (file.ok()) SayNotices(*file);
  }
  if (fs::exists(fs::path(dataset.folder) / "legend.csv")) return;
  std::cerr << "terra: " << dataset.folder << " has no legend.csv: " << map
            << " is read under the legend multiterrapath\n";
}

}  // namespace terra::cli
