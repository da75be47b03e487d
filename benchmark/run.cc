#include "benchmark/run.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "advisor/encoding.h"
#include "benchmark/case_work.h"
#include "benchmark/parallel.h"
#include "benchmark/progress.h"
#include "benchmark/results_file.h"
#include "benchmark/run_description.h"
#include "terrain/files/whole_file.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTableBytes = std::size_t{1} << 30;

// A method's open results.
struct OpenRun {
  const MethodRun* run = nullptr;
  std::unique_ptr<ResultsFile> results;
  RunDescription description;
  std::set<std::string> models;
};

std::string DescriptionPath(const MethodRun& run) {
  return (fs::path(run.folder) / "run.json").string();
}

// A new run.json, or the one that is there with one more start.
Result<RunDescription> BeginDescription(const MethodRun& run,
                                        RunDescription description) {
  const std::string path = DescriptionPath(run);
  if (fs::exists(path)) {
    const Result<RunDescription> before = ReadRunDescription(path);
    if (!before.ok()) return before.error();
    if (!before->SameFigures(description) ||
        before->shard.index != description.shard.index ||
        before->shard.count != description.shard.count) {
      return Error{ErrorCode::kInvalid,
                   run.folder +
                       " holds another run (see its run.json); "
                       "choose another folder or remove it"};
    }
    description.started = before->started;
    description.started.push_back(UtcNow());
    description.models = before->models;
    description.recorded = before->recorded;
    // A part that ran with several jobs did not take one case at a time.
    description.jobs = std::max(description.jobs, before->jobs);
  }
  const Status written = WriteRunDescription(description, path);
  if (!written.ok()) return written.error();
  return description;
}

Result<OpenRun> Open(const MethodRun& run, const IdIndex& cases, int repeats,
                     RunDescription description) {
  std::error_code failed;
  fs::create_directories(run.folder, failed);
  if (failed) {
    return Error{ErrorCode::kUnavailable, run.folder + ": " + failed.message()};
  }
  OpenRun open;
  open.run = &run;
  auto results = ResultsFile::Open(
      (fs::path(run.folder) / "results.csv").string(), cases, repeats,
      run.choice.info.several_candidates ? ResultColumns::kWithCandidates
                                         : ResultColumns::kUsual);
  if (!results.ok()) return results.error();
  open.results = *std::move(results);
  Result<RunDescription> begun = BeginDescription(run, std::move(description));
  if (!begun.ok()) return begun.error();
  open.description = *std::move(begun);
  open.models.insert(open.description.models.begin(),
                     open.description.models.end());
  return open;
}

// Runs what is left of the cases, several at a time.
class Runner {
 public:
  /// `cases`: those of the run, each with its place in the dataset.
  Runner(const Dataset& dataset, const std::vector<std::uint32_t>& cases,
         const RunOptions& options, std::vector<OpenRun>& runs)
      : dataset_(dataset), cases_(cases), options_(options), runs_(runs) {}

  Status Run() {
    const std::vector<std::size_t> left = CasesLeft();
    const auto total = static_cast<std::int64_t>(NumOfShard());
    const auto count = static_cast<std::int64_t>(left.size());
    Progress progress("run", total, total - count);
    ParallelFor(count, options_.jobs, [&](std::int64_t i) {
      if (!failed()) RunCase(left[static_cast<std::size_t>(i)]);
      progress.Advance();
    });
    if (failure_) return *failure_;
    return Done{};
  }

 private:
  // Methods belong to the thread that made them.
  using Methods = std::vector<std::unique_ptr<Method>>;

  bool InShard(std::size_t index) const {
    const auto count = static_cast<std::size_t>(options_.shard.count);
    return index % count + 1 == static_cast<std::size_t>(options_.shard.index);
  }

  std::size_t NumOfShard() const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < cases_.size(); ++i) n += InShard(i);
    return n;
  }

  bool IsDone(const OpenRun& run, std::size_t index) const {
    for (int repeat = 0; repeat < options_.repeats; ++repeat) {
      if (!run.results->IsDone(index, repeat)) return false;
    }
    return true;
  }

  std::vector<std::size_t> CasesLeft() const {
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      const bool done =
          std::all_of(runs_.begin(), runs_.end(), [&](const OpenRun& run) {
            return IsDone(run, i);
          });
      if (InShard(i) && !done) left.push_back(i);
    }
    return left;
  }

  void RunCase(std::size_t index) {
    const DatasetCase& c = dataset_.cases[cases_[index]];
    const Result<CaseWork> work = BeginCase(dataset_, c, options_);
    if (!work.ok()) return Fail(work.error());
    Result<Methods> methods = TakeMethods();
    if (!methods.ok()) return Fail(methods.error());
    for (std::size_t m = 0; m < runs_.size(); ++m) {
      for (int repeat = 0; repeat < options_.repeats; ++repeat) {
        if (runs_[m].results->IsDone(index, repeat)) continue;
        Keep(runs_[m],
             TryCase(*work, runs_[m].run->choice.info, *(*methods)[m], repeat));
      }
    }
    const std::scoped_lock lock(mutex_);
    idle_.push_back(*std::move(methods));
  }

  void Keep(OpenRun& run, const TriedCase& tried) {
    const Status written = run.results->Append(tried.result);
    if (!written.ok()) return Fail(written.error());
    const Status described = Describe(run, tried);
    if (!described.ok()) Fail(described.error());
  }

  // Into run.json at once, so that a run that is killed keeps it.
  Status Describe(OpenRun& run, const TriedCase& tried) {
    const std::scoped_lock lock(mutex_);
    RunDescription& d = run.description;
    const std::string days = d.recorded.Days();
    d.recorded.Add(tried.recorded_at);
    const bool named =
        !tried.model.empty() && run.models.insert(tried.model).second;
    if (!named && d.recorded.Days() == days) return Done{};
    d.models = {run.models.begin(), run.models.end()};
    return WriteRunDescription(d, DescriptionPath(*run.run));
  }

  Result<Methods> TakeMethods() {
    {
      const std::scoped_lock lock(mutex_);
      if (!idle_.empty()) {
        Methods methods = std::move(idle_.back());
        idle_.pop_back();
        return methods;
      }
    }
    Methods methods;
    for (const OpenRun& run : runs_) {
      auto method = run.run->choice.make();
      if (!method.ok()) return method.error();
      methods.push_back(*std::move(method));
    }
    return methods;
  }

  bool failed() {
    const std::scoped_lock lock(mutex_);
    return failure_.has_value();
  }

  void Fail(const Error& error) {
    const std::scoped_lock lock(mutex_);
    if (!failure_) failure_ = error;
  }

  const Dataset& dataset_;
  const std::vector<std::uint32_t>& cases_;
  const RunOptions& options_;
  std::vector<OpenRun>& runs_;
  std::mutex mutex_;
  std::vector<Methods> idle_;
  std::optional<Error> failure_;
};

// The places of these cases in the dataset; of none, of all.
Result<std::vector<std::uint32_t>> PlacesOf(
    const Dataset& dataset, const std::vector<std::string>& ids) {
  std::vector<std::uint32_t> places(ids.size());
  if (ids.empty()) {
    places.resize(dataset.cases.size());
    std::iota(places.begin(), places.end(), 0U);
    return places;
  }
  const IdIndex index = IndexOf(dataset.cases);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::optional<std::size_t> place = index.Find(ids[i]);
    if (!place) {
      return Error{ErrorCode::kInvalid,
                   dataset.folder + ": has no case '" + ids[i] + "'"};
    }
    places[i] = static_cast<std::uint32_t>(*place);
  }
  return places;
}

IdIndex CasesAt(const Dataset& dataset,
                const std::vector<std::uint32_t>& places) {
  std::vector<const std::string*> ids;
  ids.reserve(places.size());
  for (const std::uint32_t place : places) {
    ids.push_back(&dataset.cases[place].case_id);
  }
  return IdIndex(std::move(ids));
}

Status Finish(OpenRun& open) {
  const Status sorted = open.results->Finish();
  if (!sorted.ok()) return sorted.error();
  open.description.finished = UtcNow();
  return WriteRunDescription(open.description, DescriptionPath(*open.run));
}

}  // namespace

std::vector<std::string> FirstOfEachGroup(const Dataset& dataset, int n) {
  std::map<std::string, int> taken;
  std::vector<std::string> ids;
  for (const DatasetCase& c : dataset.cases) {
    if (taken[c.group]++ < n) ids.push_back(c.case_id);
  }
  return ids;
}

Result<std::string> DatasetDigest(const Dataset& dataset) {
  if (!dataset.digest.empty()) return dataset.digest;
  const Result<std::string> cases = ReadWholeFile(
      (fs::path(dataset.folder) / "cases.csv").string(), kMaxTableBytes);
  if (!cases.ok()) return cases.error();
  return "cases.csv:" + advisor::Sha256Hex(*cases);
}

Status RunMethods(const Dataset& dataset, const RunOptions& options,
                  const std::vector<MethodRun>& runs, const RunOrigin& origin) {
  const auto places = PlacesOf(dataset, options.cases);
  if (!places.ok()) return places.error();
  const IdIndex cases = CasesAt(dataset, *places);
  const Result<std::string> digest = DatasetDigest(dataset);
  if (!digest.ok()) return digest.error();
  std::vector<OpenRun> open;
  for (const MethodRun& run : runs) {
    Result<OpenRun> opened =
        Open(run, cases, options.repeats,
             DescribeRun(dataset, cases, options, run, origin, *digest));
    if (!opened.ok()) return opened.error();
    open.push_back(*std::move(opened));
  }
  const Status ran = Runner(dataset, *places, options, open).Run();
  if (!ran.ok()) return ran.error();
  for (OpenRun& run : open) {
    const Status finished = Finish(run);
    if (!finished.ok()) return finished.error();
  }
  return Done{};
}

}  // namespace terra::benchmark
