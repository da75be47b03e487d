// CSV, legends and datasets: what is read, written and read again is the same.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "terrain/files/csv.h"
#include "terrain/files/dataset.h"
#include "terrain/files/legend_file.h"
#include "tests/fuzz/fuzz.h"

namespace {

const std::filesystem::path& Folder() {
  static const std::filesystem::path folder = [] {
    auto path = std::filesystem::temp_directory_path() /
                ("terra-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(path);
    return path;
  }();
  return folder;
}

void Save(const std::string& name, std::string_view text) {
  std::ofstream(Folder() / name, std::ios::binary) << text;
}

void CheckCsv(std::string_view text) {
  const auto table = terra::ParseCsv(text, "input");
  if (!table) return;
  std::string again = terra::CsvLine(table->header);
  for (const terra::CsvRow& row : table->rows) {
    again += terra::CsvLine(row.fields);
  }
  const auto reread = terra::ParseCsv(again, "again");
  terra::fuzz::Require(reread && reread->header == table->header &&
                           reread->rows.size() == table->rows.size(),
                       "CSV is read back as it was written");
  for (std::size_t i = 0; i < table->rows.size(); ++i) {
    terra::fuzz::Require(reread->rows[i].fields == table->rows[i].fields,
                         "CSV fields are read back as they were written");
  }
}

void CheckLegend(std::string_view text) {
  Save("legend.csv", text);
  const auto legend = terra::ReadLegend((Folder() / "legend.csv").string());
  if (!legend) return;
  const std::string written = (Folder() / "written.csv").string();
  terra::fuzz::Require(terra::WriteLegend(*legend, written).ok() &&
                           terra::ReadLegend(written) &&
                           *terra::ReadLegend(written) == *legend,
                       "a legend is read back as it was written");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text = terra::fuzz::Text(data + 1, size - 1);
  switch (data[0] % 3) {
    case 0:
      CheckCsv(text);
      break;
    case 1:
      CheckLegend(text);
      break;
    default:
      Save("cases.csv", text);
      terra::fuzz::RequireReason(terra::ReadDataset(Folder().string()));
  }
  return 0;
}
