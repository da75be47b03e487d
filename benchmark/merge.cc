#include "benchmark/merge.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <utility>

#include "benchmark/case_result.h"
#include "benchmark/run_description.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

std::string ResultsPath(const std::string& folder) {
  return (fs::path(folder) / "results.csv").string();
}

// A shard on disk: its rows lie `count` places apart in the whole run.
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

// A row's place in the whole run, and where it stands now.
struct Row {
  std::int64_t order = 0;
  std::size_t shard = 0;
  std::int64_t offset = 0;
  std::int64_t length = 0;
};

// Finds the rows of a shard. A finished shard has its rows in order of cases;
// the k-th case of shard i of n is case k n + i - 1 of the list.
Status FindRows(const ShardRows& shard, std::size_t number,
                std::set<std::string>& seen, std::vector<Row>& rows) {
  std::optional<Error> failure;
  std::int64_t k = -1;
  std::string last_id;
  const auto begin = rows.size();
  const Status read =
      ReadResults(ResultsPath(shard.folder), [&](const CaseResult& r) {
        if (r.case_id != last_id) ++k;
        last_id = r.case_id;
        const std::string key = r.case_id + "#" + std::to_string(r.repeat);
        if (!seen.insert(key).second) {
          failure =
              Error{ErrorCode::kInvalid, shard.folder + ": case " + r.case_id +
                                             " is in two of the parts"};
        }
        const RunDescription& d = shard.description;
        const std::int64_t index = k * d.shard.count + d.shard.index - 1;
        rows.push_back({index * d.repeats + r.repeat, number, 0, 0});
      });
  if (!read.ok()) return read.error();
  if (failure) return *failure;
  std::ifstream file(ResultsPath(shard.folder), std::ios::binary);
  std::string line;
  std::getline(file, line);
  auto offset = static_cast<std::int64_t>(line.size()) + 1;
  for (std::size_t i = begin; std::getline(file, line); ++i) {
    rows.at(i).offset = offset;
    rows.at(i).length = static_cast<std::int64_t>(line.size()) + 1;
    offset += rows.at(i).length;
  }
  return Done{};
}

Status CopyRows(const std::vector<ShardRows>& shards,
                const std::vector<Row>& rows, const std::string& path) {
  std::vector<std::ifstream> files;
  for (const ShardRows& shard : shards) {
    files.emplace_back(ResultsPath(shard.folder), std::ios::binary);
  }
  std::ofstream to(path, std::ios::binary | std::ios::trunc);
  to << ResultsHeader();
  std::string line;
  for (const Row& row : rows) {
    line.resize(static_cast<std::size_t>(row.length));
    files[row.shard].seekg(row.offset);
    files[row.shard].read(line.data(), row.length);
    to << line;
  }
  if (to.flush()) return Done{};
  return Error{ErrorCode::kUnavailable, path + ": cannot be written"};
}

RunDescription MergedDescription(const std::vector<ShardRows>& shards) {
  RunDescription merged = shards.front().description;
  std::set<std::string> models;
  merged.started.clear();
  merged.jobs = 1;
  for (const ShardRows& shard : shards) {
    const RunDescription& d = shard.description;
    merged.started.insert(merged.started.end(), d.started.begin(),
                          d.started.end());
    merged.finished = std::max(merged.finished, d.finished);
    merged.jobs = std::max(merged.jobs, d.jobs);
    models.insert(d.models.begin(), d.models.end());
  }
  std::sort(merged.started.begin(), merged.started.end());
  merged.models = {models.begin(), models.end()};
  merged.shard = {};
  return merged;
}

}  // namespace

Result<MergeCounts> MergeRuns(const std::vector<std::string>& folders,
                              const std::string& out) {
  const auto shards = LoadShards(folders);
  if (!shards.ok()) return shards.error();
  if (fs::exists(ResultsPath(out))) {
    return Error{ErrorCode::kInvalid,
                 out + " holds results already; choose another folder"};
  }
  std::vector<Row> rows;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < shards->size(); ++i) {
    const Status found = FindRows((*shards)[i], i, seen, rows);
    if (!found.ok()) return found.error();
  }
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return std::pair(a.order, a.shard) < std::pair(b.order, b.shard);
  });
  std::error_code failed;
  fs::create_directories(out, failed);
  const Status copied = CopyRows(*shards, rows, ResultsPath(out));
  if (!copied.ok()) return copied.error();
  const RunDescription merged = MergedDescription(*shards);
  const Status written =
      WriteRunDescription(merged, (fs::path(out) / "run.json").string());
  if (!written.ok()) return written.error();
  const auto count = static_cast<std::int64_t>(rows.size());
  return MergeCounts{count, merged.num_cases * merged.repeats - count};
}

}  // namespace terra::benchmark
