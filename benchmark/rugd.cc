#include "benchmark/rugd.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <utility>

#include <nlohmann/json.hpp>

#include "advisor/encoding.h"
#include "benchmark/generate_dataset.h"
#include "benchmark/parallel.h"
#include "benchmark/progress.h"
#include "output/output_file.h"
#include "terrain/builtin_legends.h"
#include "terrain/digest.h"
#include "terrain/files/csv.h"
#include "terrain/files/dataset.h"
#include "terrain/files/legend_file.h"
#include "terrain/files/map_file.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

// What became of a frame.
struct Converted {
  std::optional<RugdEnds> ends;
  std::string reason;
  std::int64_t map_id = 0;
};

Result<Converted> ConvertFrame(const RugdFrame& frame,
                               const RugdOptions& options) {
  MapFileOptions read;
  read.legend = "rugd";
  const Result<MapFile> file = ReadMap(frame.path, read);
  if (!file.ok()) return file.error();
  RugdDraw draw = DrawRugdEnds(file->map, options.seed, frame.name);
  Converted converted{draw.ends, std::move(draw.reason), MapId(file->map)};
  if (!converted.ends) return converted;
  const fs::path path = fs::path(options.out) / "maps" / (frame.name + ".png");
  const Status written = WriteIdPng(file->map, path.string());
  if (!written.ok()) return written.error();
  return converted;
}

DatasetCase CaseOf(const RugdFrame& frame, const RugdEnds& ends) {
  return {frame.name,  "maps/" + frame.name + ".png", ends.start, ends.goal,
          frame.group, {{"sequence", frame.sequence}}};
}

std::string Card() {
  return "# RUGD cost rasters\n\nDerived from the annotation masks of RUGD "
         "(Wigness et al., A RUGD Dataset for Autonomous Navigation and Visual "
         "Perception in Unstructured Outdoor Environments, IROS 2019). RUGD "
         "states no licence: **derived, do not redistribute**.\n\nMaps are "
         "8-bit PNGs of RUGD class ids; costs in `legend.csv` are the paper's, "
         "void is impassable (this project's choice). One start and goal per "
         "frame from hash(seed, frame name): in one passable component, at "
         "least 100 cells apart, joined by a lattice route of stride 50. "
         "Frames without such a pair are in `skipped.csv` with the reason.\n";
}

struct Tables {
  std::vector<DatasetCase> cases;
  std::string skipped = CsvLine({"frame", "reason"});
  std::string digest_lines;
  std::map<std::string, RugdCount> counts;
};

Tables MakeTables(const std::vector<RugdFrame>& frames,
                  const std::vector<Converted>& converted) {
  Tables tables;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    RugdCount& count = tables.counts[frames[i].group];
    count.group = frames[i].group;
    ++count.frames;
    if (!converted[i].ends) {
      tables.skipped += CsvLine({frames[i].name, converted[i].reason});
      continue;
    }
    ++count.used;
    const RugdEnds& ends = *converted[i].ends;
    tables.cases.push_back(CaseOf(frames[i], ends));
    tables.digest_lines +=
        DigestLine(frames[i].name, converted[i].map_id, ends.start, ends.goal);
  }
  return tables;
}

std::string DatasetJson(const RugdOptions& options, const Tables& tables) {
  nlohmann::ordered_json json = {
      {"name", "rugd"},
      {"version", "1"},
      {"notice", "derived from RUGD, do not redistribute"},
      {"seed", options.seed},
      {"draws", kRugdDraws},
      {"end_distance", kRugdEndDistance},
      {"stride_with_a_route", kRugdStride}};
  for (const auto& [group, count] : tables.counts) {
    json["groups"][group] = {{"frames", count.frames}, {"used", count.used}};
  }
  if (!options.frames.empty()) {
    json["frames"] = fs::absolute(options.frames).string();
  }
  json["digest"] = advisor::Sha256Hex(tables.digest_lines);
  return json.dump(2) + "\n";
}

Status WriteTables(const RugdOptions& options, const Tables& tables) {
  const fs::path out(options.out);
  const Status legend =
      WriteLegend(RugdLegend(), (out / "legend.csv").string());
  if (!legend.ok()) return legend.error();
  const std::pair<const char*, std::string> files[] = {
      {"dataset.json", DatasetJson(options, tables)},
      {"skipped.csv", tables.skipped},
      {"README.md", Card()}};
  for (const auto& [name, content] : files) {
    const Status written = WriteWholeFile((out / name).string(), content);
    if (!written.ok()) return written.error();
  }
  return WriteCases(tables.cases, (out / "cases.csv").string());
}

Status PrepareFolder(const fs::path& out) {
  if (fs::exists(out / "cases.csv")) {
    return Error{ErrorCode::kInvalid,
                 out.string() +
                     " holds a dataset already; choose another "
                     "folder or remove it"};
  }
  std::error_code failed;
  fs::create_directories(out / "maps", failed);
  if (!failed) return Done{};
  return Error{ErrorCode::kUnavailable, out.string() + ": " + failed.message()};
}

}  // namespace

std::string RugdFramesOf(const DatasetFolder& dataset) {
  const auto json = nlohmann::json::parse(dataset.json, nullptr, false);
  const auto found = json.is_object() ? json.find("frames") : json.end();
  return found != json.end() && found->is_string() ? found->get<std::string>()
                                                   : "";
}

Result<std::vector<RugdFrame>> FindRugdFrames(const std::string& folder) {
  std::map<std::string, RugdFrame> frames;
  std::error_code failed;
  for (fs::recursive_directory_iterator it(folder, failed), end;
       !failed && it != end; it.increment(failed)) {
    const std::string name = it->path().stem().string();
    const std::size_t last = name.rfind('_');
    if (it->path().extension() != ".png" || last == std::string::npos) continue;
    const RugdFrame frame{it->path().string(), name, name.substr(0, last),
                          name.substr(0, name.find_first_of("-_"))};
    if (!frames.emplace(name, frame).second) {
      return Error{ErrorCode::kInvalid,
                   folder + ": frame " + name + " stands there twice"};
    }
  }
  if (failed || frames.empty()) {
    return Error{ErrorCode::kNotFound,
                 folder + ": no RUGD images (SCENE_NNNNN.png) below it"};
  }
  std::vector<RugdFrame> sorted;
  for (auto& [name, frame] : frames) sorted.push_back(std::move(frame));
  return sorted;
}

Result<std::vector<RugdCount>> ConvertRugd(const RugdOptions& options) {
  const auto frames = FindRugdFrames(options.annotations);
  if (!frames.ok()) return frames.error();
  const Status prepared = PrepareFolder(options.out);
  if (!prepared.ok()) return prepared.error();
  std::vector<Converted> converted(frames->size());
  std::optional<Error> failure;
  std::mutex mutex;
  const auto count = static_cast<std::int64_t>(frames->size());
  Progress progress("rugd", count);
  ParallelFor(count, options.jobs, [&](std::int64_t i) {
    const auto index = static_cast<std::size_t>(i);
    Result<Converted> one = ConvertFrame((*frames)[index], options);
    progress.Advance();
    const std::scoped_lock lock(mutex);
    if (one.ok()) {
      converted[index] = *std::move(one);
    } else if (!failure) {
      failure = one.error();
    }
  });
  if (failure) return *failure;
  const Tables tables = MakeTables(*frames, converted);
  const Status written = WriteTables(options, tables);
  if (!written.ok()) return written.error();
  std::vector<RugdCount> counts;
  for (const auto& [group, one] : tables.counts) counts.push_back(one);
  return counts;
}

}  // namespace terra::benchmark
