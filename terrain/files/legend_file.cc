#include "terrain/files/legend_file.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <utility>
#include <vector>

#include "output/output_file.h"
#include "terrain/builtin_legends.h"
#include "terrain/files/csv.h"

namespace terra {
namespace {

Result<Color> ParseColor(std::string_view text) {
  std::uint32_t rgb = 0;
  if (text.size() == 7 && text[0] == '#') {
    const char* end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data() + 1, end, rgb, 16);
    if (parsed.ec == std::errc() && parsed.ptr == end) return FromRgb(rgb);
  }
  return Error{ErrorCode::kInvalid,
               "'" + std::string(text) + "' is not a colour (#RRGGBB)"};
}

Error AtLine(const std::string& path, const CsvRow& row, const Error& error) {
  return Error{error.code,
               path + ":" + std::to_string(row.line) + ": " + error.message};
}

Result<Terrain> ParseTerrain(const CsvTable& table, const CsvRow& row,
                             const std::string& path) {
  const auto field = [&](std::string_view column) -> const std::string& {
    return row.fields[static_cast<std::size_t>(table.Column(column))];
  };
  const Result<int> id = ParseInteger(field("id"));
  if (!id.ok()) return AtLine(path, row, id.error());
  const Result<double> cost = ParseNumber(field("cost"));
  if (!cost.ok()) return AtLine(path, row, cost.error());
  const Result<Color> color = ParseColor(field("color"));
  if (!color.ok()) return AtLine(path, row, color.error());
  return Terrain{*id, field("name"), *cost, *color};
}

std::string JoinedBuiltinNames() {
  std::string names;
  for (const std::string_view name : BuiltinLegendNames()) {
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names;
}

}  // namespace

Result<Legend> ReadLegend(const std::string& name_or_path) {
  if (const Legend* builtin = FindBuiltinLegend(name_or_path)) {
    return *builtin;
  }
  const std::string& path = name_or_path;
  const Result<CsvTable> table = ReadCsv(path, {"id", "name", "cost", "color"});
  if (!table.ok()) {
    if (table.error().code != ErrorCode::kNotFound) return table.error();
    return Error{ErrorCode::kNotFound,
                 path + ": neither a file nor a built-in legend (" +
                     JoinedBuiltinNames() + ")"};
  }
  std::vector<Terrain> terrains;
  for (const CsvRow& row : table->rows) {
    Result<Terrain> terrain = ParseTerrain(*table, row, path);
    if (!terrain.ok()) return terrain.error();
    terrains.push_back(std::move(*terrain));
    // Checked row by row, so that an error names the row that breaks a rule.
    const Result<Legend> so_far = Legend::Create(terrains);
    if (!so_far.ok()) return AtLine(path, row, so_far.error());
  }
  Result<Legend> legend = Legend::Create(std::move(terrains));
  if (!legend.ok()) {
    return Error{legend.error().code, path + ": " + legend.error().message};
  }
  return legend;
}

Status WriteLegend(const Legend& legend, const std::string& path) {
  std::string text = CsvLine({"id", "name", "cost", "color"});
  for (const Terrain& terrain : legend.terrains()) {
    std::array<char, 8> color{};
    std::snprintf(color.data(), color.size(), "#%02X%02X%02X", terrain.color.r,
                  terrain.color.g, terrain.color.b);
    text += CsvLine({std::to_string(terrain.id), terrain.name,
                     FormatNumber(terrain.cost), color.data()});
  }
  return WriteWholeFile(path, text);
}

}  // namespace terra
