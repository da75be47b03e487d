#include "benchmark/merge.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <utility>

#include "benchmark/case_result.h"
#include "benchmark/results_reader.h"
#include "benchmark/run_description.h"
#include "output/output_file.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

std::string ResultsPath(const std::string& folder) {
  return (fs::path(folder) / "results.csv").string();
}

// A shard on disk.
struct ShardRows {
  std::string folder;
  RunDescription description;
};

Result<std::vector<ShardRows>> LoadShards(
    const std::vector<std::string>& folders) {
  std::vector<ShardRows> shards;
  for (const std::string& folder : folders) {
    auto description =
        ReadRunDescription((fs::path(folder) / "run.json").string());
    if (!description.ok()) return description.error();
    if (!shards.empty() &&
        !description->SameFigures(shards.front().description)) {
      return Error{ErrorCode::kInvalid,
                   folder + " and " + shards.front().folder +
                       " are parts of different runs (see their run.json)"};
    }
    shards.push_back({folder, *std::move(description)});
  }
  return shards;
}

std::string ShardName(const Shard& shard) {
  return "shard " + std::to_string(shard.index) + " of " +
         std::to_string(shard.count);
}

// Rows that a shard has when it is finished.
std::int64_t NumRowsDue(const RunDescription& d) {
  return d.shard.NumOf(d.num_cases) * d.repeats;
}

// What a shard lacks, as text; empty when it is finished.
Result<std::string> WhatIsLeft(const ShardRows& shard) {
  const std::int64_t due = NumRowsDue(shard.description);
  if (shard.description.finished.empty()) {
    return ShardName(shard.description.shard) + " in " + shard.folder +
           " is not finished: start it again";
  }
  std::int64_t rows = 0;
  const Status read =
      ReadResults(ResultsPath(shard.folder), [&](const CaseResult&) {
        ++rows;
      });
  if (!read.ok()) return read.error();
  if (rows == due) return std::string();
  return ShardName(shard.description.shard) + " in " + shard.folder + " has " +
         std::to_string(rows) + " of " + std::to_string(due) + " rows";
}

// Puts the shards into order of their numbers. Every one of them must be there
// once and finished; the error names all that are not.
Status OrderShards(std::vector<ShardRows>& shards) {
  const int count = shards.front().description.shard.count;
  std::vector<ShardRows> ordered(static_cast<std::size_t>(count));
  for (ShardRows& shard : shards) {
    const Shard& part = shard.description.shard;
    if (part.count != count) {
      return Error{ErrorCode::kInvalid,
                   shard.folder + " is " + ShardName(part) +
                       ", others are parts of " + std::to_string(count)};
    }
    ShardRows& place = ordered[static_cast<std::size_t>(part.index - 1)];
    if (!place.folder.empty()) {
      return Error{ErrorCode::kInvalid, place.folder + " and " + shard.folder +
                                            " are both " + ShardName(part)};
    }
    place = std::move(shard);
  }
  std::string left;
  for (int i = 0; i < count; ++i) {
    const ShardRows& shard = ordered[static_cast<std::size_t>(i)];
    Result<std::string> what = shard.folder.empty()
                                   ? ShardName({i + 1, count}) + " is missing"
                                   : WhatIsLeft(shard);
    if (!what.ok()) return what.error();
    if (!what->empty()) left += (left.empty() ? "" : "; ") + *what;
  }
  if (!left.empty()) return Error{ErrorCode::kUnavailable, left};
  shards = std::move(ordered);
  return Done{};
}

// Deals the rows back as the cases were dealt: finished shards have theirs in
// order of the cases, and case k of shard i of n is case k n + i - 1.
Result<std::int64_t> CopyRows(const std::vector<ShardRows>& shards,
                              const std::string& path) {
  std::vector<std::ifstream> files;
  std::string header;
  for (const ShardRows& shard : shards) {
    files.emplace_back(ResultsPath(shard.folder), std::ios::binary);
    std::getline(files.back(), header);  // The same in all.
  }
  Result<OutputFile> to = OutputFile::Create(path);
  if (!to.ok()) return to.error();
  to->Write(header + "\n");
  const RunDescription& whole = shards.front().description;
  std::int64_t rows = 0;
  std::string line;
  for (std::int64_t i = 0; i < whole.num_cases; ++i) {
    const std::size_t shard = static_cast<std::size_t>(i) % files.size();
    std::ifstream& from = files[shard];
    for (int repeat = 0; repeat < whole.repeats; ++repeat, ++rows) {
      std::getline(from, line);
      if (!from) {
        return Error{
            ErrorCode::kUnavailable,
            ResultsPath(shards[shard].folder) + ": cannot be read to its end"};
      }
      to->Write(line + "\n");
    }
  }
  const Status written = to->Finish();
  if (!written.ok()) return written.error();
  return rows;
}

RunDescription MergedDescription(const std::vector<ShardRows>& shards) {
  RunDescription merged = shards.front().description;
  std::set<std::string> models;
  merged.started.clear();
  merged.jobs = 0;
  merged.recorded = {};
  for (const ShardRows& shard : shards) {
    const RunDescription& d = shard.description;
    merged.started.insert(merged.started.end(), d.started.begin(),
                          d.started.end());
    merged.finished = std::max(merged.finished, d.finished);
    merged.jobs += d.jobs;  // Shards run side by side.
    merged.recorded.Add(d.recorded);
    models.insert(d.models.begin(), d.models.end());
  }
  std::sort(merged.started.begin(), merged.started.end());
  merged.models = {models.begin(), models.end()};
  merged.shard = {};
  return merged;
}

}  // namespace

Result<std::int64_t> MergeRuns(const std::vector<std::string>& folders,
                               const std::string& out) {
  if (fs::exists(ResultsPath(out))) {
    return Error{ErrorCode::kInvalid,
                 out + " holds results already; choose another folder"};
  }
  auto shards = LoadShards(folders);
  if (!shards.ok()) return shards.error();
  const Status ordered = OrderShards(*shards);
  if (!ordered.ok()) return ordered.error();
  std::error_code failed;
  fs::create_directories(out, failed);
  const Status written = WriteRunDescription(
      MergedDescription(*shards), (fs::path(out) / "run.json").string());
  if (!written.ok()) return written.error();
  return CopyRows(*shards, ResultsPath(out));
}

}  // namespace terra::benchmark
