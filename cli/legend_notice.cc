#include "cli/legend_notice.h"

#include <filesystem>
#include <iostream>
#include <optional>

#include "terrain/files/case_reader.h"

namespace terra::cli {

namespace fs = std::filesystem;

void NoteDefaultLegend(const DatasetFolder& dataset) {
  if (fs::exists(fs::path(dataset.folder) / "legend.csv")) return;
  Result<CaseReader> cases = CaseReader::Open(dataset.folder);
  if (!cases.ok()) return;  // What is wrong is said by who needs the cases.
  const Result<std::optional<DatasetCase>> first = cases->Next();
  if (!first.ok() || !first->has_value()) return;
  const std::string& map = (*first)->map;
  if (fs::path(map).extension() == ".png") return;
  std::cerr << "terra: " << dataset.folder << " has no legend.csv: " << map
            << " is read under the legend multiterrapath\n";
}

}  // namespace terra::cli
