#include "benchmark/run.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "base/utc.h"
#include "benchmark/case_work.h"
#include "benchmark/ordered_pipeline.h"
#include "benchmark/progress.h"
#include "benchmark/results_file.h"
#include "benchmark/run_description.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

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

// What run.json is to say: of a new run, or of the one that is there with one
// more start.
Result<RunDescription> Continued(const MethodRun& run,
                                 RunDescription description) {
  const std::string path = DescriptionPath(run);
  if (!fs::exists(path)) return description;
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
  return description;
}

Result<OpenRun> Open(const MethodRun& run, const CaseList& cases, int repeats,
                     const RunDescription& description) {
  std::error_code failed;
  fs::create_directories(run.folder, failed);
  if (failed) {
    return Error{ErrorCode::kUnavailable, run.folder + ": " + failed.message()};
  }
  // Before the results of another run are touched; and again below, when
  // nobody else can write them any more.
  const Result<RunDescription> fits = Continued(run, description);
  if (!fits.ok()) return fits.error();
  OpenRun open;
  open.run = &run;
  auto results = ResultsFile::Open(
      (fs::path(run.folder) / "results.csv").string(), IdsOf(cases), repeats,
      run.choice.info.several_candidates ? ResultColumns::kWithCandidates
                                         : ResultColumns::kUsual);
  if (!results.ok()) return results.error();
  open.results = *std::move(results);
  Result<RunDescription> begun = Continued(run, description);
  if (!begun.ok()) return begun.error();
  open.description = *std::move(begun);
  const Status written =
      WriteRunDescription(open.description, DescriptionPath(run));
  if (!written.ok()) return written.error();
  open.models.insert(open.description.models.begin(),
                     open.description.models.end());
  return open;
}

// A case and its place in the list.
struct NumberedCase {
  std::size_t index = 0;
  DatasetCase dataset_case;
};

// What came of a case that was left, of each method and repeat.
struct TriedMethods {
  struct One {
    OpenRun* run = nullptr;
    TriedCase tried;
  };
  std::size_t index = 0;
  std::vector<One> all;
};

// Runs what is left of the cases, several at a time.
class Runner {
 public:
  Runner(const DatasetFolder& dataset, CaseCursor cases,
         const RunOptions& options, std::vector<OpenRun>& runs)
      : dataset_(dataset),
        cases_(std::move(cases)),
        options_(options),
        runs_(runs) {}

  /// `total`: the number of cases; `title`: what progress lines call it.
  Status Run(std::int64_t total, const std::string& title) {
    Progress progress(title, total, NumDone(total));
    OrderedPipeline<NumberedCase, TriedMethods> work(
        [this] {
          return NextLeft();
        },
        [this](const NumberedCase& c) {
          return Try(c);
        },
        [&](const TriedMethods& tried) {
          progress.Advance();
          return Keep(tried);
        });
    return work.Run(options_.jobs);
  }

 private:
  // Methods belong to the thread that made them.
  using Methods = std::vector<std::unique_ptr<Method>>;

  bool IsDone(std::size_t index) const {
    for (const OpenRun& run : runs_) {
      for (int repeat = 0; repeat < options_.repeats; ++repeat) {
        if (!run.results->IsDone(index, repeat)) return false;
      }
    }
    return true;
  }

  std::int64_t NumDone(std::int64_t total) const {
    std::int64_t n = 0;
    for (std::int64_t i = 0; i < total; ++i) {
      n += IsDone(static_cast<std::size_t>(i)) ? 1 : 0;
    }
    return n;
  }

  Result<std::optional<NumberedCase>> NextLeft() {
    for (;; ++next_index_) {
      Result<std::optional<DatasetCase>> next = cases_.Next();
      if (!next.ok()) return next.error();
      if (!next->has_value()) return std::optional<NumberedCase>();
      if (IsDone(next_index_)) continue;
      return std::optional(NumberedCase{next_index_++, **std::move(next)});
    }
  }

  Result<TriedMethods> Try(const NumberedCase& c) {
    const Result<CaseWork> work = BeginCase(dataset_, c.dataset_case, options_);
    if (!work.ok()) return work.error();
    Result<Methods> methods = TakeMethods();
    if (!methods.ok()) return methods.error();
    TriedMethods result{c.index, {}};
    for (std::size_t m = 0; m < runs_.size(); ++m) {
      for (int repeat = 0; repeat < options_.repeats; ++repeat) {
        if (runs_[m].results->IsDone(c.index, repeat)) continue;
        result.all.push_back(
            {&runs_[m], TryCase(*work, runs_[m].run->choice.info,
                                *(*methods)[m], repeat)});
      }
    }
    const std::scoped_lock lock(mutex_);
    idle_.push_back(*std::move(methods));
    return result;
  }

  static Status Keep(const TriedMethods& tried) {
    for (const auto& [run, one] : tried.all) {
      const Status written = run->results->Append(tried.index, one.result);
      if (!written.ok()) return written;
      const Status described = Describe(*run, one);
      if (!described.ok()) return described;
    }
    return Done{};
  }

  // Into run.json at once, so that a run that is killed keeps it.
  static Status Describe(OpenRun& run, const TriedCase& tried) {
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

  const DatasetFolder& dataset_;
  CaseCursor cases_;
  const RunOptions& options_;
  std::vector<OpenRun>& runs_;
  std::size_t next_index_ = 0;
  std::mutex mutex_;
  std::vector<Methods> idle_;
};

Status Finish(OpenRun& open) {
  const Status sorted = open.results->Finish();
  if (!sorted.ok()) return sorted.error();
  open.description.finished = UtcNow();
  return WriteRunDescription(open.description, DescriptionPath(*open.run));
}

}  // namespace

std::string ProgressTitle(const std::vector<MethodRun>& runs) {
  std::string title = "run";
  for (const MethodRun& run : runs) {
    const MethodInfo& info = run.choice.info;
    title += (&run == &runs.front() ? " " : ", ") + info.method +
             (info.backend.empty() ? "" : " " + info.backend);
  }
  return title;
}

Status RunMethods(const DatasetFolder& dataset, const RunOptions& options,
                  const std::vector<MethodRun>& runs, const RunOrigin& origin) {
  const CaseList cases{dataset.folder, options.cases, options.shard};
  const Result<CaseSurvey> survey = SurveyCases(dataset, options.cases);
  if (!survey.ok()) return survey.error();
  std::vector<OpenRun> open;
  for (const MethodRun& run : runs) {
    Result<OpenRun> opened =
        Open(run, cases, options.repeats,
             DescribeRun(dataset, *survey, options, run, origin));
    if (!opened.ok()) return opened.error();
    open.push_back(*std::move(opened));
  }
  Result<CaseCursor> cursor = CaseCursor::Open(cases);
  if (!cursor.ok()) return cursor.error();
  const Status ran =
      Runner(dataset, *std::move(cursor), options, open)
          .Run(options.shard.NumOf(survey->num_selected), ProgressTitle(runs));
  if (!ran.ok()) return ran.error();
  for (OpenRun& run : open) {
    const Status finished = Finish(run);
    if (!finished.ok()) return finished.error();
  }
  return Done{};
}

}  // namespace terra::benchmark
