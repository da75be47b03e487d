#include "benchmark/rugd.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <mutex>
#include <utility>

#include <nlohmann/json.hpp>

#include "advisor/encoding.h"
#include "benchmark/generate_dataset.h"
#include "benchmark/hidden_path.h"
#include "benchmark/parallel.h"
#include "benchmark/progress.h"
#include "output/output_file.h"
#include "terrain/builtin_legends.h"
#include "terrain/digest.h"
#include "terrain/files/csv.h"
#include "terrain/files/dataset.h"
#include "terrain/files/legend_file.h"
#include "terrain/files/map_file.h"
#include "terrain/files/whole_file.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxMaskBytes = std::size_t{64} << 20;

// What became of a frame.
struct Converted {
  std::optional<RugdEnds> ends;
  std::string reason;  // Why there are none.
  std::int64_t map_id = 0;
  bool read = true;  // Its mask could be.
};

Result<Converted> ConvertFrame(const RugdFrame& frame,
                               const RugdOptions& options) {
  MapFileOptions read;
  read.legend = "rugd";
  const Result<MapFile> file = ReadMap(frame.path, read);
  if (!file.ok()) return Converted{{}, file.error().message, 0, false};
  RugdDraw draw = DrawRugdEnds(file->map, options.seed, frame.name);
  Converted converted{draw.ends, std::move(draw.reason), MapId(file->map),
                      true};
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
         "Frames without such a pair are in `skipped.csv` with the reason, as "
         "is "
         "every file that is no readable mask.\n";
}

struct Tables {
  std::vector<DatasetCase> cases;
  std::string skipped = CsvLine({"frame", "reason"});
  std::string digest_lines;
  std::map<std::string, RugdCount> counts;
};

Tables MakeTables(const RugdFolder& folder,
                  const std::vector<Converted>& converted) {
  const std::vector<RugdFrame>& frames = folder.frames;
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
  for (const RugdSkipped& skipped : folder.skipped) {
    tables.skipped += CsvLine({skipped.name, skipped.reason});
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
  return json.dump(2, ' ', false,
                   nlohmann::ordered_json::error_handler_t::replace) +
         "\n";
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

bool NoneIsRead(const std::vector<Converted>& converted) {
  return std::none_of(converted.begin(), converted.end(),
                      [](const Converted& one) {
                        return one.read;
                      });
}

// Every entry but folders, in order of the paths; of a hidden folder only the
// folder itself.
Result<std::vector<fs::path>> FilesBelow(const std::string& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  fs::recursive_directory_iterator it(folder, failed);
  for (const fs::recursive_directory_iterator end; !failed && it != end;
       it.increment(failed)) {
    std::error_code unknown;
    if (it->is_directory(unknown)) {
      if (!IsHidden(it->path())) continue;
      it.disable_recursion_pending();
    }
    files.push_back(it->path());
  }
  if (failed) {
    return Error{
        ErrorCode::kUnavailable,
        folder + ": not all below it can be read: " + failed.message()};
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool IsFrameName(const std::string& stem) {
  const std::size_t last = stem.rfind('_');
  return last != std::string::npos && last > 0 && last + 1 < stem.size() &&
         stem.find_first_not_of("0123456789", last + 1) == std::string::npos;
}

bool IsPng(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) {
                   return static_cast<char>(std::tolower(c));
                 });
  return extension == ".png";
}

// Empty for a frame.
std::string WhyNoFrame(const fs::path& path) {
  std::error_code failed;
  if (IsHidden(path)) return "hidden and so no image of RUGD";
  if (!IsPng(path) || !IsFrameName(path.stem().string())) {
    return "not called SCENE_NNNNN.png";
  }
  return fs::is_regular_file(path, failed) ? "" : "no regular file";
}

RugdFrame FrameOf(const fs::path& path) {
  const std::string name = path.stem().string();
  return {path.string(), name, name.substr(0, name.rfind('_')),
          name.substr(0, name.find_first_of("-_"))};
}

bool HaveSameContent(const fs::path& a, const fs::path& b) {
  const auto first = ReadWholeFile(a.string(), kMaxMaskBytes);
  const auto second = ReadWholeFile(b.string(), kMaxMaskBytes);
  return first.ok() && second.ok() && *first == *second;
}

}  // namespace

std::string RugdFramesOf(const DatasetFolder& dataset) {
  const auto json = nlohmann::json::parse(dataset.json, nullptr, false);
  const auto found = json.is_object() ? json.find("frames") : json.end();
  return found != json.end() && found->is_string() ? found->get<std::string>()
                                                   : "";
}

Result<RugdFolder> FindRugdFrames(const std::string& folder) {
  const Result<std::vector<fs::path>> files = FilesBelow(folder);
  if (!files.ok()) return files.error();
  RugdFolder found;
  std::map<std::string, RugdFrame> frames;
  for (const fs::path& path : *files) {
    const std::string below = path.lexically_relative(folder).string();
    const std::string why = WhyNoFrame(path);
    if (!why.empty()) {
      found.skipped.push_back({below, why});
      continue;
    }
    const RugdFrame frame = FrameOf(path);
    const auto [first, added] = frames.emplace(frame.name, frame);
    if (added) continue;
    if (!HaveSameContent(path, first->second.path)) {
      return Error{ErrorCode::kInvalid,
                   folder + ": frame " + frame.name +
                       " stands there twice, and not the same: " +
                       first->second.path + ", " + path.string()};
    }
    found.skipped.push_back({below, "the same as " + first->second.path});
  }
  if (frames.empty()) {
    return Error{ErrorCode::kNotFound,
                 folder + ": no RUGD images (SCENE_NNNNN.png) below it"};
  }
  for (auto& [name, frame] : frames) found.frames.push_back(std::move(frame));
  return found;
}

Result<std::vector<RugdCount>> ConvertRugd(const RugdOptions& options) {
  const Result<RugdFolder> folder = FindRugdFrames(options.annotations);
  if (!folder.ok()) return folder.error();
  const Status prepared = PrepareFolder(options.out);
  if (!prepared.ok()) return prepared.error();
  std::vector<Converted> converted(folder->frames.size());
  std::optional<Error> failure;
  std::mutex mutex;
  const auto count = static_cast<std::int64_t>(folder->frames.size());
  Progress progress("rugd masks", count);
  ParallelFor(count, options.jobs, [&](std::int64_t i) {
    const auto index = static_cast<std::size_t>(i);
    Result<Converted> one = ConvertFrame(folder->frames[index], options);
    progress.Advance();
    const std::scoped_lock lock(mutex);
    if (one.ok()) {
      converted[index] = *std::move(one);
    } else if (!failure) {
      failure = one.error();
    }
  });
  if (failure) return *failure;
  if (NoneIsRead(converted)) {
    return Error{ErrorCode::kInvalid,
                 "no mask below " + options.annotations +
                     " can be read; the first: " + converted.front().reason};
  }
  const Tables tables = MakeTables(*folder, converted);
  const Status written = WriteTables(options, tables);
  if (!written.ok()) return written.error();
  std::vector<RugdCount> counts;
  for (const auto& [group, one] : tables.counts) counts.push_back(one);
  return counts;
}

}  // namespace terra::benchmark
