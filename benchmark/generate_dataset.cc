#include "benchmark/generate_dataset.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "advisor/encoding.h"
#include "benchmark/dataset_card.h"
#include "benchmark/parallel.h"
#include "benchmark/progress.h"
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

// What is kept of a case once its map is on disk.
struct WrittenCase {
  std::int64_t map_id = 0;
  Cell start;
  Cell goal;
  std::array<char, 64> map_sha256{};
};

struct WrittenSubset {
  Subset subset;
  std::vector<WrittenCase> cases;
  Rejections rejections;
};

std::string MapPath(Subset subset, int index) {
  return "maps/" + CaseId(subset, index) + ".png";
}

Result<WrittenCase> WriteCase(const GeneratedCase& generated,
                              const std::string& path) {
  const Status written = WriteIdPng(generated.map, path);
  if (!written.ok()) return written.error();
  const Result<std::string> bytes = ReadWholeFile(path, kMaxMapBytes);
  if (!bytes.ok()) return bytes.error();
  WrittenCase result{MapId(generated.map), generated.start, generated.goal, {}};
  advisor::Sha256Hex(*bytes).copy(result.map_sha256.data(),
                                  result.map_sha256.size());
  return result;
}

Result<WrittenSubset> WriteSubset(Subset subset, const GenerateOptions& options,
                                  const fs::path& folder) {
  WrittenSubset result{subset, {}, {}};
  result.cases.resize(static_cast<std::size_t>(options.count));
  const MapParameters parameters = CalibratedParameters(subset);
  std::optional<Error> failure;
  std::mutex mutex;
  Progress progress("generate " + std::string(SubsetName(subset)),
                    options.count);
  ParallelFor(options.count, options.jobs, [&](std::int64_t i) {
    const auto index = static_cast<int>(i);
    const GeneratedCase generated =
        GenerateCase(subset, options.seed, index, parameters);
    const Result<WrittenCase> written =
        WriteCase(generated, (folder / MapPath(subset, index)).string());
    progress.Advance();
    const std::scoped_lock lock(mutex);
    if (!written.ok()) {
      if (!failure) failure = written.error();
      return;
    }
    result.cases[static_cast<std::size_t>(i)] = *written;
    result.rejections += generated.rejections;
  });
  if (failure) return *failure;
  return result;
}

// cases.csv as text, and the dataset's digest.
struct CaseTable {
  std::string csv;
  std::string digest;
};

CaseTable MakeCaseTable(const std::vector<WrittenSubset>& subsets) {
  std::string csv = CsvLine(
      {"case_id", "map", "start_x", "start_y", "goal_x", "goal_y", "group"});
  std::string lines;
  for (const WrittenSubset& subset : subsets) {
    for (int i = 0; i < static_cast<int>(subset.cases.size()); ++i) {
      const WrittenCase& c = subset.cases[static_cast<std::size_t>(i)];
      const std::string id = CaseId(subset.subset, i);
      csv += CsvLine({id, MapPath(subset.subset, i), std::to_string(c.start.x),
                      std::to_string(c.start.y), std::to_string(c.goal.x),
                      std::to_string(c.goal.y),
                      std::string(SubsetName(subset.subset))});
      lines += DigestLine(id, c.map_id, c.start, c.goal);
    }
  }
  return {std::move(csv), advisor::Sha256Hex(lines)};
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
                        const std::vector<WrittenSubset>& subsets,
                        const std::string& digest) {
  ordered_json json = {{"name", options.name},
                       {"version", options.version},
                       {"generator_version", kGeneratorVersion},
                       {"seed", options.seed},
                       {"legend", "multiterrapath"}};
  for (const WrittenSubset& subset : subsets) {
    json["subsets"][std::string(SubsetName(subset.subset))] = {
        {"count", subset.cases.size()},
        {"parameters", ToJson(CalibratedParameters(subset.subset))},
        {"rejections", ToJson(subset.rejections)}};
  }
  json["digest"] = digest;
  return json.dump(2) + "\n";
}

// SHA256SUMS in the form that `sha256sum -c` reads.
std::string Sums(const std::vector<std::pair<std::string, std::string>>& files,
                 const std::vector<WrittenSubset>& subsets) {
  std::string text;
  for (const auto& [name, content] : files) {
    text += advisor::Sha256Hex(content) + "  " + name + "\n";
  }
  for (const WrittenSubset& subset : subsets) {
    for (int i = 0; i < static_cast<int>(subset.cases.size()); ++i) {
      const auto& sum = subset.cases[static_cast<std::size_t>(i)].map_sha256;
      text += std::string(sum.data(), sum.size()) + "  " +
              MapPath(subset.subset, i) + "\n";
    }
  }
  return text;
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

Status WriteTables(const GenerateOptions& options,
                   const std::vector<WrittenSubset>& subsets,
                   const CaseTable& table, const fs::path& folder) {
  const std::string legend_path = (folder / "legend.csv").string();
  const Status legend_written =
      WriteLegend(MultiTerraPathLegend(), legend_path);
  if (!legend_written.ok()) return legend_written.error();
  const Result<std::string> legend = ReadWholeFile(legend_path, kMaxMapBytes);
  if (!legend.ok()) return legend.error();
  const std::vector<std::pair<std::string, std::string>> files = {
      {"dataset.json", DatasetJson(options, subsets, table.digest)},
      {"legend.csv", *legend},
      {"README.md", DatasetCard(options)},
      {"cases.csv", table.csv}};
  const std::string sums = Sums(files, subsets);
  const Status summed = WriteWholeFile((folder / "SHA256SUMS").string(), sums);
  if (!summed.ok()) return summed.error();
  for (const auto& [name, content] : files) {
    const Status written = WriteWholeFile((folder / name).string(), content);
    if (!written.ok()) return written.error();
  }
  return Done{};
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
  std::vector<WrittenSubset> subsets;
  for (const Subset subset : options.subsets) {
    Result<WrittenSubset> written = WriteSubset(subset, options, folder);
    if (!written.ok()) return written.error();
    subsets.push_back(*std::move(written));
  }
  CaseTable table = MakeCaseTable(subsets);
  const Status written = WriteTables(options, subsets, table, folder);
  if (!written.ok()) return written.error();
  return std::move(table.digest);
}

}  // namespace terra::benchmark
