#include "benchmark/generate_dataset.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "advisor/encoding.h"
#include "benchmark/dataset_card.h"
#include "benchmark/ordered_pipeline.h"
#include "benchmark/progress.h"
#include "output/output_file.h"
#include "terrain/builtin_legends.h"
#include "terrain/digest.h"
#include "terrain/files/csv.h"
#include "terrain/files/legend_file.h"
#include "terrain/files/map_file.h"
#include "terrain/files/whole_file.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t kMaxMapBytes = std::size_t{1} << 26;

// What is kept of a case once its map is on disk, until its lines are written.
struct WrittenCase {
  Subset subset;
  int index = 0;
  std::int64_t map_id = 0;
  Cell start;
  Cell goal;
  std::string map_sha256;
  Rejections rejections;
};

std::string MapPath(Subset subset, int index) {
  return "maps/" + CaseId(subset, index) + ".png";
}

Result<WrittenCase> WriteCase(Subset subset, int index,
                              const GeneratedCase& generated,
                              const std::string& path) {
  const Status written = WriteIdPng(generated.map, path);
  if (!written.ok()) return written.error();
  const Result<std::string> bytes = ReadWholeFile(path, kMaxMapBytes);
  if (!bytes.ok()) return bytes.error();
  return WrittenCase{subset,
                     index,
                     MapId(generated.map),
                     generated.start,
                     generated.goal,
                     advisor::Sha256Hex(*bytes),
                     generated.rejections};
}

// The tables with a line for each case. They grow on disk, not in memory, and
// get their names when they are whole.
class CaseTables {
 public:
  static Result<std::unique_ptr<CaseTables>> Create(const fs::path& folder) {
    const fs::path sums_path = folder / "SHA256SUMS";
    Result<OutputFile> cases =
        OutputFile::Create((folder / "cases.csv").string());
    if (!cases.ok()) return cases.error();
    Result<TemporaryFile> maps =
        TemporaryFile::Create(sums_path.string() + ".maps", 0600);
    if (!maps.ok()) {
      return Error{ErrorCode::kUnavailable,
                   folder.string() + ": " + maps.error().message};
    }
    std::unique_ptr<CaseTables> tables(
        new CaseTables(sums_path, *std::move(cases), *std::move(maps)));
    tables->AddRow(
        {"case_id", "map", "start_x", "start_y", "goal_x", "goal_y", "group"});
    return tables;
  }

  // In order of the cases.
  Status Add(const WrittenCase& c) {
    const std::string id = CaseId(c.subset, c.index);
    const std::string map = MapPath(c.subset, c.index);
    AddRow({id, map, std::to_string(c.start.x), std::to_string(c.start.y),
            std::to_string(c.goal.x), std::to_string(c.goal.y),
            std::string(SubsetName(c.subset))});
    digest_.Add(DigestLine(id, c.map_id, c.start, c.goal));
    map_sums_ << c.map_sha256 << "  " << map << "\n";
    if (!map_sums_) return MapSumsLost();
    return cases_.status();
  }

  // The dataset's digest; once, when all cases were added.
  std::string Digest() { return digest_.Hex(); }

  // Writes SHA256SUMS, in the form that `sha256sum -c` reads: first of the
  // other tables, whose lines are given, then of cases.csv and the maps.
  Status FinishSums(std::string lines) {
    map_sums_.close();
    if (!map_sums_) return MapSumsLost();
    Result<OutputFile> sums = OutputFile::Create(sums_path_.string());
    if (!sums.ok()) return sums.error();
    sums->Write(lines + cases_sum_.Hex() + "  cases.csv\n");
    std::ifstream of_maps(map_sums_file_.path(), std::ios::binary);
    for (std::string line; std::getline(of_maps, line);) {
      sums->Write(line + "\n");
    }
    return sums->Finish();
  }

  // Names cases.csv.
  Status FinishCases() { return cases_.Finish(); }

 private:
  CaseTables(fs::path sums_path, OutputFile cases, TemporaryFile map_sums)
      : sums_path_(std::move(sums_path)),
        cases_(std::move(cases)),
        map_sums_file_(std::move(map_sums)),
        map_sums_(map_sums_file_.path(), std::ios::binary) {}

  Error MapSumsLost() const {
    return {ErrorCode::kUnavailable,
            map_sums_file_.path() + ": cannot be written"};
  }

  void AddRow(const std::vector<std::string>& fields) {
    const std::string line = CsvLine(fields);
    cases_sum_.Add(line);
    cases_.Write(line);
  }

  const fs::path sums_path_;
  OutputFile cases_;
  TemporaryFile map_sums_file_;  // The maps' lines until the others are known.
  std::ofstream map_sums_;
  advisor::Sha256 cases_sum_;
  advisor::Sha256 digest_;
};

// Returns what was rejected on the way.
Result<Rejections> WriteSubset(Subset subset, const GenerateOptions& options,
                               const fs::path& folder, CaseTables& tables) {
  const MapParameters parameters = CalibratedParameters(subset);
  Rejections rejections;
  int next = 0;
  Progress progress("generate " + std::string(SubsetName(subset)),
                    options.count);
  OrderedPipeline<int, WrittenCase> work(
      [&]() -> Result<std::optional<int>> {
        if (next == options.count) return std::optional<int>();
        return std::optional(next++);
      },
      [&](const int& index) {
        return WriteCase(subset, index,
                         GenerateCase(subset, options.seed, index, parameters),
                         (folder / MapPath(subset, index)).string());
      },
      [&](const WrittenCase& c) {
        progress.Advance();
        rejections += c.rejections;
        return tables.Add(c);
      });
  const Status done = work.Run(options.jobs);
  if (!done.ok()) return done.error();
  return rejections;
}

ordered_json ToJson(IntRange range) {
  return ordered_json::array({range.low, range.high});
}

ordered_json ToJson(const MapParameters& p) {
  ordered_json json = {
      {"side", p.side},
      {"polygons", ToJson(p.polygons)},
      {"polygon_radius", ToJson(p.star.radius)},
      {"polygon_corners", ToJson(p.star.corners)},
      {"polygon_corner_percent", ToJson(p.star.percent)},
      {"polygon_separation", p.separation},
      {"obstacles", ToJson(p.obstacles)},
      {"obstacle_short_side", ToJson(p.obstacle_short)},
      {"obstacle_long_side", ToJson(p.obstacle_long)},
      {"obstacle_edge_distance", p.obstacle_edge_distance},
      {"end_margin", p.end_margin},
      {"end_distance", p.end_distance},
      {"strides_with_a_route", p.strides},
  };
  if (p.ribbon) {
    json["ribbon_half_width"] = ToJson(p.ribbon_half_width);
    json["ribbon_amplitude"] = ToJson(p.ribbon_amplitude);
    json["ribbon_angle_of_1024"] = ToJson(p.ribbon_angle);
  }
  return json;
}

ordered_json ToJson(const Rejections& r) {
  return {{"polygon_misplaced", r.polygon_misplaced},
          {"map_with_too_few_polygons", r.too_few_polygons},
          {"end_blocked", r.end_blocked},
          {"ends_too_close", r.ends_too_close},
          {"no_lattice_route", r.no_lattice_route},
          {"map_without_ends", r.no_ends_found}};
}

std::string DatasetJson(const GenerateOptions& options,
                        const std::vector<Rejections>& rejections,
                        const std::string& digest) {
  ordered_json json = {{"name", options.name},
                       {"version", options.version},
                       {"generator_version", kGeneratorVersion},
                       {"seed", options.seed},
                       {"legend", "multiterrapath"}};
  for (std::size_t i = 0; i < options.subsets.size(); ++i) {
    const Subset subset = options.subsets[i];
    json["subsets"][std::string(SubsetName(subset))] = {
        {"count", options.count},
        {"parameters", ToJson(CalibratedParameters(subset))},
        {"rejections", ToJson(rejections[i])}};
  }
  json["digest"] = digest;
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) +
         "\n";
}

Status PrepareFolder(const fs::path& folder) {
  if (fs::exists(folder / "cases.csv")) {
    return Error{ErrorCode::kInvalid,
                 folder.string() +
                     " holds a dataset already; choose another "
                     "folder or remove it"};
  }
  std::error_code failed;
  fs::create_directories(folder / "maps", failed);
  if (failed) {
    return Error{ErrorCode::kUnavailable,
                 folder.string() + ": " + failed.message()};
  }
  return Done{};
}

// Writes the tables that do not grow with the cases. Returns their lines of
// SHA256SUMS.
Result<std::string> WriteSmallTables(const std::string& json,
                                     const std::string& card,
                                     const fs::path& folder) {
  const std::string legend_path = (folder / "legend.csv").string();
  const Status legend_written =
      WriteLegend(MultiTerraPathLegend(), legend_path);
  if (!legend_written.ok()) return legend_written.error();
  const Result<std::string> legend = ReadWholeFile(legend_path, kMaxMapBytes);
  if (!legend.ok()) return legend.error();
  const std::pair<const char*, std::string> files[] = {
      {"dataset.json", json}, {"legend.csv", *legend}, {"README.md", card}};
  std::string sums;
  for (const auto& [name, content] : files) {
    const Status written = WriteWholeFile((folder / name).string(), content);
    if (!written.ok()) return written.error();
    sums += advisor::Sha256Hex(content) + "  " + name + "\n";
  }
  return sums;
}

}  // namespace

std::string CaseId(Subset subset, int index) {
  std::array<char, 16> number{};
  std::snprintf(number.data(), number.size(), "_%04d", index);
  return std::string(SubsetName(subset)) + number.data();
}

std::string DigestLine(const std::string& case_id, std::int64_t map_id,
                       Cell start, Cell goal) {
  return CsvLine({case_id, std::to_string(map_id), std::to_string(start.x),
                  std::to_string(start.y), std::to_string(goal.x),
                  std::to_string(goal.y)});
}

Result<std::string> GenerateDataset(const GenerateOptions& options,
                                    const std::string& folder) {
  const Status prepared = PrepareFolder(folder);
  if (!prepared.ok()) return prepared.error();
  const auto tables = CaseTables::Create(folder);
  if (!tables.ok()) return tables.error();
  std::vector<Rejections> rejections;
  for (const Subset subset : options.subsets) {
    const auto rejected = WriteSubset(subset, options, folder, **tables);
    if (!rejected.ok()) return rejected.error();
    rejections.push_back(*rejected);
  }
  std::string digest = (*tables)->Digest();
  const auto sums = WriteSmallTables(DatasetJson(options, rejections, digest),
                                     DatasetCard(options), folder);
  if (!sums.ok()) return sums.error();
  const Status summed = (*tables)->FinishSums(*sums);
  if (!summed.ok()) return summed.error();
  const Status finished = (*tables)->FinishCases();
  if (!finished.ok()) return finished.error();
  return digest;
}

}  // namespace terra::benchmark
