#include "benchmark/loaded_run.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include "benchmark/hidden_path.h"
#include "benchmark/integer_random.h"
#include "benchmark/results_reader.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

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
  digest = Mixed(digest, CaseKey(score.case_id));
  digest = Mixed(digest, static_cast<std::uint64_t>(score.map_id));
  return Mixed(digest, std::bit_cast<std::uint64_t>(score.baseline_cost));
}

// Gathers the figures of one group.
struct GroupBuilder {
  std::string group;
  MetricsBuilder metrics;
  RepeatsBuilder repeats;
};

// A run of very many cases is summed up from a sample of them.
struct Samples {
  CasePart cases;
  CasePart repeats;  // Of which more is kept.
};

GroupBuilder& BuilderOf(std::vector<GroupBuilder>& builders,
                        const std::string& group, const CountingRule& rule,
                        const Samples& samples) {
  const auto found = std::find_if(builders.begin(), builders.end(),
                                  [&](const GroupBuilder& builder) {
                                    return builder.group == group;
                                  });
  if (found != builders.end()) return *found;
  return builders.emplace_back(
      GroupBuilder{group, MetricsBuilder(rule, samples.cases),
                   RepeatsBuilder(rule, samples.repeats)});
}

// A case as two runs must have it alike.
struct CaseFacts {
  std::uint64_t key = 0;
  std::int64_t map_id = 0;
  double baseline_cost = 0;
};

bool KeyIsLess(const CaseFacts& a, const CaseFacts& b) {
  return a.key < b.key;
}

// Those of a part, in order of the keys.
Result<std::vector<CaseFacts>> ReadFacts(const LoadedRun& run, CasePart part) {
  std::vector<CaseFacts> facts;
  const Status read = run.read([&](const Score& score) {
    const std::uint64_t key = CaseKey(score.case_id);
    if (score.repeat != 0 || !part.Takes(key)) return;
    facts.push_back({key, score.map_id, score.baseline_cost});
  });
  if (!read.ok()) return read.error();
  std::sort(facts.begin(), facts.end(), KeyIsLess);
  return facts;
}

// A case of a part that both have on different maps or baselines.
Result<std::string> DifferentCase(const LoadedRun& a, const LoadedRun& b,
                                  CasePart part) {
  std::string different;
  const auto of_a = ReadFacts(a, part);
  if (!of_a.ok()) return of_a.error();
  const Status read = b.read([&](const Score& score) {
    const CaseFacts in_b{CaseKey(score.case_id), score.map_id,
                         score.baseline_cost};
    const auto found =
        std::lower_bound(of_a->begin(), of_a->end(), in_b, KeyIsLess);
    if (!different.empty() || found == of_a->end() || found->key != in_b.key) {
      return;
    }
    if (in_b.map_id != found->map_id ||
        in_b.baseline_cost != found->baseline_cost) {
      different = score.case_id;
    }
  });
  if (!read.ok()) return read.error();
  return different;
}

// Runs with the same cases have none, which is seen without reading their rows.
Result<std::string> DifferentCase(const LoadedRun& a, const LoadedRun& b) {
  if (a.cases_digest == b.cases_digest) return std::string();
  const std::uint64_t parts = NumParts(a.num_rows);
  for (CasePart part{0, parts}; part.index < parts; ++part.index) {
    Result<std::string> different = DifferentCase(a, b, part);
    if (!different.ok() || !different->empty()) return different;
  }
  return std::string();
}

// Whether two runs have the same of what rows of a table share.
struct SharedValue {
  Shared what;
  std::string name;
  bool same;
};

std::vector<SharedValue> SharedValues(const LoadedRun& a, const LoadedRun& b) {
  const RunDescription& x = a.description;
  const RunDescription& y = b.description;
  return {{Shared::kDataset, "dataset", x.dataset_digest == y.dataset_digest},
          {Shared::kCaseList, "case list",
           x.case_list_digest == y.case_list_digest},
          {Shared::kStride, "stride", x.stride == y.stride},
          {Shared::kJoints, "joint rule", x.joints == y.joints},
          {Shared::kCostModel, "cost model",
           x.corner_cutting == y.corner_cutting &&
               x.clearance_cells == y.clearance_cells}};
}

std::optional<Mismatch> MismatchIn(Shared what, const std::string& name,
                                   const LoadedRun& a, const LoadedRun& b) {
  return Mismatch{what,
                  a.folder + " and " + b.folder + " differ in their " + name};
}

Result<std::vector<std::string>> RunsBelow(const std::string& folder) {
  std::vector<std::string> below;
  std::error_code failed;
  fs::recursive_directory_iterator it(folder, failed);
  for (const fs::recursive_directory_iterator end; !failed && it != end;
       it.increment(failed)) {
    std::error_code unknown;
    if (!it->is_directory(unknown)) continue;
    if (IsHidden(it->path())) {
      it.disable_recursion_pending();
    } else if (IsRunFolder(it->path().string())) {
      below.push_back(it->path().string());
    }
  }
  if (failed) {
    return Error{
        ErrorCode::kUnavailable,
        folder + ": not all below it can be read: " + failed.message()};
  }
  std::sort(below.begin(), below.end());
  return below;
}

// In ascending order.
using Keys = std::vector<std::uint64_t>;

Result<Keys> KeysOf(const LoadedRun& run) {
  Keys keys;
  const Status read = run.read([&](const Score& score) {
    const std::uint64_t key = CaseKey(score.case_id);
    // A run names a case once for each repeat.
    if (keys.empty() || keys.back() != key) keys.push_back(key);
  });
  if (!read.ok()) return read.error();
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

// The cases that every run has. Pre: there is one.
Result<Keys> CommonKeys(const std::vector<LoadedRun>& runs) {
  Result<Keys> common = KeysOf(runs.front());
  for (std::size_t i = 1; common.ok() && i < runs.size(); ++i) {
    const Result<Keys> keys = KeysOf(runs[i]);
    if (!keys.ok()) return keys.error();
    std::erase_if(*common, [&](std::uint64_t key) {
      return !std::binary_search(keys->begin(), keys->end(), key);
    });
  }
  return common;
}

}  // namespace

Status SumUp(LoadedRun& run, std::int64_t at_once) {
  const CountingRule& rule = run.description.rule;
  const std::int64_t cases = run.description.num_cases;
  const Samples samples = {{0, NumParts(cases, at_once)},
                           {0, NumParts(4 * cases, at_once)}};
  std::vector<GroupBuilder> builders;
  run.num_rows = run.num_unanswered = 0;
  run.cases_digest = 0;
  const Status read = run.read([&](const Score& score) {
    ++run.num_rows;
    run.num_unanswered += score.kind == AttemptKind::kNoAnswer ? 1 : 0;
    run.cases_digest = CasesDigest(run.cases_digest, score);
    GroupBuilder& builder = BuilderOf(builders, score.group, rule, samples);
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

bool IsRunFolder(const std::string& folder) {
  std::error_code failed;
  return fs::is_regular_file(fs::path(folder) / "run.json", failed);
}

Result<std::vector<std::string>> FindRuns(
    const std::vector<std::string>& folders) {
  std::vector<std::string> found;
  for (const std::string& folder : folders) {
    if (IsRunFolder(folder)) {
      found.push_back(folder);
      continue;
    }
    Result<std::vector<std::string>> below = RunsBelow(folder);
    if (!below.ok()) return below.error();
    if (below->empty()) {
      return Error{ErrorCode::kNotFound,
                   folder + ": no run here (a folder with run.json)"};
    }
    found.insert(found.end(), below->begin(), below->end());
  }
  return found;
}

Result<std::vector<LoadedRun>> LoadRuns(const std::vector<std::string>& folders,
                                        std::vector<std::string>* others) {
  const Result<std::vector<std::string>> found = FindRuns(folders);
  if (!found.ok()) return found.error();
  std::vector<LoadedRun> runs;
  for (const std::string& folder : *found) {
    Result<LoadedRun> run = LoadRun(folder);
    if (run.ok()) {
      runs.push_back(*std::move(run));
      continue;
    }
    const bool named =
        std::find(folders.begin(), folders.end(), folder) != folders.end();
    if (named || run.error().code != ErrorCode::kUnsupported) {
      return run.error();
    }
    if (others != nullptr) others->push_back(run.error().message);
  }
  return runs;
}

Result<std::optional<Mismatch>> FindMismatch(const LoadedRun& a,
                                             const LoadedRun& b,
                                             const std::set<Shared>& varies) {
  for (const SharedValue& value : SharedValues(a, b)) {
    if (!value.same && !varies.contains(value.what)) {
      return MismatchIn(value.what, value.name, a, b);
    }
  }
  if (a.description.stride != b.description.stride ||
      a.description.joints != b.description.joints) {
    return std::optional<Mismatch>();
  }
  const Result<std::string> id = DifferentCase(a, b);
  if (!id.ok()) return id.error();
  if (id->empty()) return std::optional<Mismatch>();
  return MismatchIn(Shared::kBaselines, "map or baseline of case " + *id, a, b);
}

Status KeepCommonCases(std::vector<LoadedRun>& runs) {
  const bool same =
      std::all_of(runs.begin(), runs.end(), [&](const LoadedRun& run) {
        return run.cases_digest == runs.front().cases_digest;
      });
  if (same) return Done{};
  Result<Keys> keys = CommonKeys(runs);
  if (!keys.ok()) return keys.error();
  const auto common = std::make_shared<const Keys>(*std::move(keys));
  for (LoadedRun& run : runs) {
    run.read = [common, all = std::move(run.read)](
                   const std::function<void(const Score&)>& use) {
      return all([&](const Score& score) {
        const bool taken = std::binary_search(common->begin(), common->end(),
                                              CaseKey(score.case_id));
        if (taken) use(score);
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
