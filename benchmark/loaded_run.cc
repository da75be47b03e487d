#include "benchmark/loaded_run.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <functional>
#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "benchmark/integer_random.h"
#include "benchmark/results_reader.h"

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
  const std::string path = (fs::path(folder) / "results.csv").string();
  run.read = [path](const std::function<void(const Score&)>& use) {
    return ReadResults(path, [&](const CaseResult& result) {
      use(ToScore(result));
    });
  };
  const Status summed = SumUp(run);
  if (!summed.ok()) return summed.error();
  return run;
}

std::uint64_t Mixed(std::uint64_t digest, std::uint64_t more) {
  return IntegerRandom::Mix(digest + IntegerRandom::Mix(more));
}

// Chains what identifies the case of a row to those before.
std::uint64_t CasesDigest(std::uint64_t digest, const Score& score) {
  digest = Mixed(digest, std::hash<std::string>{}(score.case_id));
  digest = Mixed(digest, static_cast<std::uint64_t>(score.map_id));
  return Mixed(digest, std::bit_cast<std::uint64_t>(score.baseline_cost));
}

// Gathers the figures of one group.
struct GroupBuilder {
  std::string group;
  MetricsBuilder metrics;
  RepeatsBuilder repeats;
};

GroupBuilder& BuilderOf(std::vector<GroupBuilder>& builders,
                        const std::string& group, const CountingRule& rule) {
  const auto found = std::find_if(builders.begin(), builders.end(),
                                  [&](const GroupBuilder& builder) {
                                    return builder.group == group;
                                  });
  if (found != builders.end()) return *found;
  return builders.emplace_back(
      GroupBuilder{group, MetricsBuilder(rule), RepeatsBuilder(rule)});
}

// A case as two runs must have it alike.
struct CaseFacts {
  std::int64_t map_id = 0;
  double baseline_cost = 0;
};

// The first case that both have on different maps or baselines. Runs with the
// same cases have none, which is seen without reading their rows.
Result<std::string> DifferentCase(const LoadedRun& a, const LoadedRun& b) {
  std::string different;
  if (a.cases_digest == b.cases_digest) return different;
  std::unordered_map<std::string, CaseFacts> of_a;
  const Status read_a = a.read([&](const Score& score) {
    of_a.emplace(score.case_id, CaseFacts{score.map_id, score.baseline_cost});
  });
  if (!read_a.ok()) return read_a.error();
  const Status read_b = b.read([&](const Score& score) {
    const auto found = of_a.find(score.case_id);
    if (!different.empty() || found == of_a.end()) return;
    if (score.map_id != found->second.map_id ||
        score.baseline_cost != found->second.baseline_cost) {
      different = score.case_id;
    }
  });
  if (!read_b.ok()) return read_b.error();
  return different;
}

using IdSet = std::unordered_set<std::string>;

// The ids that every run has.
Result<IdSet> CommonIds(const std::vector<LoadedRun>& runs) {
  struct Seen {
    std::size_t runs = 0;
    std::size_t last = 0;  // A run names a case once for each repeat.
  };
  std::unordered_map<std::string, Seen> seen;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Status read = runs[i].read([&](const Score& score) {
      Seen& of_case = seen[score.case_id];
      if (of_case.runs > 0 && of_case.last == i) return;
      ++of_case.runs;
      of_case.last = i;
    });
    if (!read.ok()) return read.error();
  }
  IdSet common;
  for (const auto& [id, of_case] : seen) {
    if (of_case.runs == runs.size()) common.insert(id);
  }
  return common;
}

}  // namespace

Status SumUp(LoadedRun& run) {
  const CountingRule& rule = run.description.rule;
  std::vector<GroupBuilder> builders;
  run.num_rows = run.num_unanswered = 0;
  run.cases_digest = 0;
  const Status read = run.read([&](const Score& score) {
    ++run.num_rows;
    run.num_unanswered += score.kind == AttemptKind::kNoAnswer ? 1 : 0;
    run.cases_digest = CasesDigest(run.cases_digest, score);
    GroupBuilder& builder = BuilderOf(builders, score.group, rule);
    builder.metrics.Add(score);
    if (run.description.repeats > 1) builder.repeats.Add(score);
  });
  if (!read.ok()) return read;
  run.groups.clear();
  for (GroupBuilder& builder : builders) {
    run.groups.push_back(
        {builder.group, builder.metrics.Finish(), builder.repeats.Figures()});
    builder.metrics = MetricsBuilder(rule);  // Its columns are long.
  }
  return Done{};
}

bool LoadedRun::complete() const {
  return num_unanswered == 0 &&
         num_rows == description.num_cases * description.repeats;
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
    const Result<std::string> id = DifferentCase(a, b);
    if (!id.ok()) return id.error().message;
    if (!id->empty()) what = "map or baseline of case " + *id;
  }
  if (what.empty()) return "";
  return a.folder + " and " + b.folder + " differ in their " + what;
}

Status KeepCommonCases(std::vector<LoadedRun>& runs) {
  const bool same =
      std::all_of(runs.begin(), runs.end(), [&](const LoadedRun& run) {
        return run.cases_digest == runs.front().cases_digest;
      });
  if (same) return Done{};
  Result<IdSet> ids = CommonIds(runs);
  if (!ids.ok()) return ids.error();
  const auto common = std::make_shared<const IdSet>(*std::move(ids));
  for (LoadedRun& run : runs) {
    run.read = [common, all = std::move(run.read)](
                   const std::function<void(const Score&)>& use) {
      return all([&](const Score& score) {
        if (common->contains(score.case_id)) use(score);
      });
    };
    const Status summed = SumUp(run);
    if (!summed.ok()) return summed;
  }
  return Done{};
}

ScoreReader ReaderOfGroup(const LoadedRun& run, const std::string& group) {
  return [group, all = run.read](const std::function<void(const Score&)>& use) {
    return all([&](const Score& score) {
      if (score.group == group) use(score);
    });
  };
}

std::vector<std::string> GroupsOf(const LoadedRun& run) {
  std::vector<std::string> groups;
  for (const GroupFigures& figures : run.groups) {
    groups.push_back(figures.group);
  }
  return groups;
}

const GroupFigures& FiguresOf(const LoadedRun& run, const std::string& group) {
  static const GroupFigures kNothing;
  for (const GroupFigures& figures : run.groups) {
    if (figures.group == group) return figures;
  }
  return kNothing;
}

const Metrics& MetricsOf(const LoadedRun& run, const std::string& group) {
  return FiguresOf(run, group).metrics;
}

}  // namespace terra::benchmark
