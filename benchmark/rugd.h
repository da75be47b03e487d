#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmark/rugd_ends.h"
#include "terrain/files/dataset.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// How RUGD masks become a dataset.
struct RugdOptions {
  /// The official archive (SCENE/SCENE_NNNNN.png) or a flat folder of masks.
  std::string annotations;
  std::string out;
  /// The camera frames, named as their masks; only noted in dataset.json, for
  /// the report's pictures. Empty = none.
  std::string frames;
  std::uint64_t seed = 0;
  int jobs = 0;  ///< 0 = all cores.
};

/// A frame's name in parts: "trail-10_00001" is frame 00001 of sequence
/// trail-10 in group trail.
struct RugdFrame {
  std::string path;      ///< Of the mask.
  std::string name;      ///< Without extension.
  std::string sequence;  ///< Up to the last underscore.
  std::string group;     ///< Up to the first `-` or `_`.
};

/// Where a converted dataset says that its camera frames are; empty = nowhere.
std::string RugdFramesOf(const DatasetFolder& dataset);

/// A file that is not converted, and why.
struct RugdSkipped {
  std::string name;  ///< Of a frame; else its path below the folder.
  std::string reason;
};

/// What a folder of masks or camera frames holds.
struct RugdFolder {
  std::vector<RugdFrame> frames;     ///< In order of their names; at least one.
  std::vector<RugdSkipped> skipped;  ///< What else is there, in order of paths.
};

/// Looks for images called SCENE_NNNNN.png below a folder. Everything else is
/// skipped: other files, hidden files and folders (of macOS, say), a second
/// file of the same name and content.
/// Errors: no such image; two of one name with different content; a folder that
/// cannot be looked into.
Result<RugdFolder> FindRugdFrames(const std::string& folder);

/// What came of it, per group.
struct RugdCount {
  std::string group;
  std::int64_t frames = 0;
  std::int64_t used = 0;
};

/// Writes the dataset: id maps, cases.csv (with group and sequence),
/// legend.csv, dataset.json, skipped.csv (frame, reason) and README.md. A mask
/// that cannot be read, or has a colour that RUGD does not have (named with its
/// pixel), is skipped.
/// Errors: those of FindRugdFrames; no mask that can be read (why the first one
/// cannot); a folder that holds a dataset already.
Result<std::vector<RugdCount>> ConvertRugd(const RugdOptions& options);

}  // namespace terra::benchmark
