#include "benchmark/loaded_run.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

bool IsRun(const fs::path& folder) {
  return fs::exists(folder / "run.json");
}

Result<LoadedRun> LoadRun(const std::string& folder) {
  LoadedRun run;
  run.folder = folder;
  Result<RunDescription> description =
      ReadRunDescription((fs::path(folder) / "run.json").string());
  if (!description.ok()) return description.error();
  run.description = *std::move(description);
  const Status read = ReadResults((fs::path(folder) / "results.csv").string(),
                                  [&](const CaseResult& result) {
                                    run.scores.push_back(ToScore(result));
                                  });
  if (!read.ok()) return read.error();
  return run;
}

// The first case that both have on different maps or baselines.
std::string DifferentCase(const LoadedRun& a, const LoadedRun& b) {
  std::unordered_map<std::string_view, const Score*> of_a;
  for (const Score& score : a.scores) of_a.emplace(score.case_id, &score);
  for (const Score& score : b.scores) {
    const auto found = of_a.find(score.case_id);
    if (found == of_a.end()) continue;
    const Score& other = *found->second;
    if (score.map_id != other.map_id ||
        score.baseline_cost != other.baseline_cost) {
      return score.case_id;
    }
  }
  return "";
}

}  // namespace

bool LoadedRun::complete() const {
  return num_unanswered() == 0 &&
         static_cast<std::int64_t>(scores.size()) ==
             description.num_cases * description.repeats;
}

std::int64_t LoadedRun::num_unanswered() const {
  return std::count_if(scores.begin(), scores.end(), [](const Score& score) {
    return score.kind == AttemptKind::kNoAnswer;
  });
}

Result<std::vector<std::string>> FindRuns(
    const std::vector<std::string>& folders) {
  std::vector<std::string> found;
  for (const std::string& folder : folders) {
    if (IsRun(folder)) {
      found.push_back(folder);
      continue;
    }
    std::error_code failed;
    std::vector<std::string> below;
    for (fs::recursive_directory_iterator it(folder, failed), end;
         !failed && it != end; it.increment(failed)) {
      if (it->is_directory() && IsRun(it->path())) {
        below.push_back(it->path().string());
      }
    }
    if (below.empty()) {
      return Error{ErrorCode::kNotFound,
                   folder + ": no run here (a folder with run.json)"};
    }
    std::sort(below.begin(), below.end());
    found.insert(found.end(), below.begin(), below.end());
  }
  return found;
}

Result<std::vector<LoadedRun>> LoadRuns(
    const std::vector<std::string>& folders) {
  const Result<std::vector<std::string>> found = FindRuns(folders);
  if (!found.ok()) return found.error();
  std::vector<LoadedRun> runs;
  for (const std::string& folder : *found) {
    Result<LoadedRun> run = LoadRun(folder);
    if (!run.ok()) return run.error();
    runs.push_back(*std::move(run));
  }
  return runs;
}

std::string WhyNotComparable(const LoadedRun& a, const LoadedRun& b) {
  const RunDescription& x = a.description;
  const RunDescription& y = b.description;
  std::string what;
  if (x.dataset_digest != y.dataset_digest) {
    what = "dataset";
  } else if (x.case_list_digest != y.case_list_digest) {
    what = "case list";
  } else if (x.stride != y.stride) {
    what = "stride";
  } else if (x.joints != y.joints) {
    what = "joint rule";
  } else if (x.corner_cutting != y.corner_cutting ||
             x.clearance_cells != y.clearance_cells) {
    what = "cost model";
  } else {
    const std::string id = DifferentCase(a, b);
    if (!id.empty()) what = "map or baseline of case " + id;
  }
  if (what.empty()) return "";
  return a.folder + " and " + b.folder + " differ in their " + what;
}

void KeepCommonCases(std::vector<LoadedRun>& runs) {
  std::unordered_map<std::string, std::size_t> seen;
  for (const LoadedRun& run : runs) {
    std::set<std::string_view> ids;
    for (const Score& score : run.scores) ids.insert(score.case_id);
    for (const std::string_view id : ids) ++seen[std::string(id)];
  }
  for (LoadedRun& run : runs) {
    std::erase_if(run.scores, [&](const Score& score) {
      return seen.at(score.case_id) != runs.size();
    });
  }
}

std::vector<Score> ScoresOfGroup(const LoadedRun& run,
                                 const std::string& group) {
  std::vector<Score> scores;
  for (const Score& score : run.scores) {
    if (score.group == group) scores.push_back(score);
  }
  return scores;
}

std::vector<std::string> GroupsOf(const LoadedRun& run) {
  std::vector<std::string> groups;
  for (const Score& score : run.scores) {
    if (std::find(groups.begin(), groups.end(), score.group) == groups.end()) {
      groups.push_back(score.group);
    }
  }
  return groups;
}

}  // namespace terra::benchmark
