#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <unordered_set>
#include <utility>

#include "advisor/batch_format.h"
#include "advisor/llm_methods.h"
#include "advisor/recording.h"
#include "base/utc.h"
#include "benchmark/batch.h"
#include "benchmark/llm_method.h"
#include "benchmark/progress.h"
#include "output/output_file.h"
#include "planner/coarse_lattice.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;
using advisor::BatchForm;
using advisor::LlmIdentity;
using advisor::LlmRequest;
using advisor::WireFormat;

// The files for the provider: a new one when the next item would not fit.
class RequestFiles {
 public:
  RequestFiles(std::string folder, const BatchForm& form)
      : folder_(std::move(folder)), form_(form) {}

  Status Add(const std::string& item) {
    const std::size_t added = form_.separator.size() + item.size();
    const bool full = count_ >= form_.max_requests ||
                      bytes_ + added + form_.tail.size() > form_.max_bytes;
    if (count_ > 0 && full) {
      const Status finished = Finish();
      if (!finished) return finished;
    }
    if (count_ == 0) {
      const Status begun = Begin();
      if (!begun) return begun;
    }
    Put(count_ == 0 ? form_.head : form_.separator);
    Put(item);
    ++count_;
    return file_->status();
  }

  Status Finish() {
    if (count_ == 0) return Done{};
    Put(form_.tail);
    count_ = bytes_ = 0;
    return file_->Finish();
  }

  const std::vector<std::string>& paths() const { return paths_; }

 private:
  Status Begin() {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "requests-%03zu",
                  paths_.size() + 1);
    paths_.push_back((fs::path(folder_) / name.data()).string() +
                     std::string(form_.extension));
    Result<OutputFile> file = OutputFile::Create(paths_.back());
    if (!file) return file.error();
    file_.emplace(*std::move(file));
    return Done{};
  }

  void Put(std::string_view text) {
    file_->Write(text);
    bytes_ += text.size();
  }

  const std::string folder_;
  const BatchForm& form_;
  std::vector<std::string> paths_;
  std::optional<OutputFile> file_;
  std::size_t count_ = 0;
  std::size_t bytes_ = 0;
};

// Everything that an export writes to and asks with.
struct Exporter {
  std::unique_ptr<WireFormat> format;
  advisor::GenerationSettings settings;
  LlmIdentity identity;
  std::unordered_set<std::string> recorded;
  std::string images;  // Folder; empty = not kept.
  RequestFiles files;
  OutputFile open;
  ExportedBatch counts;

  Status Add(const LlmRequest& request) {
    const std::string hash = advisor::RequestHash(identity, request);
    if (recorded.contains(advisor::RecordKey(hash, request.repeat))) {
      ++counts.left_out;
      return Done{};
    }
    if (!images.empty()) {
      const Status kept = advisor::KeepImages(request, images);
      if (!kept) return kept;
    }
    open.Write(advisor::FormatRecord(identity, request, {}, UtcNow()));
    ++counts.requests;
    return files.Add(advisor::BatchItem(
        *format, advisor::BatchId(hash, request.repeat), request, settings));
  }
};

Result<std::unique_ptr<Exporter>> MakeExporter(
    const advisor::LlmServiceOptions& service, const BatchFolder& folder) {
  const BatchForm* form = advisor::FindBatchForm(service.backend);
  if (form == nullptr) {
    return Error{ErrorCode::kUnsupported,
                 "'" + service.backend +
                     "' takes no batches; openai, anthropic and gemini do"};
  }
  const std::string open_path =
      (fs::path(folder.path) / kOpenRequestsName).string();
  if (fs::exists(open_path)) {
    return Error{ErrorCode::kInvalid,
                 folder.path + " holds a batch already; choose another folder"};
  }
  auto recorded = advisor::ReadRecordKeys(folder.except);
  if (!recorded.ok()) return recorded.error();
  const std::string images =
      folder.images ? open_path + ".images" : std::string();
  std::error_code failed;
  fs::create_directories(folder.images ? images : folder.path, failed);
  if (failed) {
    return Error{ErrorCode::kUnavailable,
                 folder.path + ": " + failed.message()};
  }
  Result<OutputFile> open = OutputFile::Create(open_path);
  if (!open) return open.error();
  auto made = std::unique_ptr<Exporter>(
      new Exporter{.format = advisor::MakeWireFormat(service.backend),
                   .settings = service.provider.settings,
                   .identity = {},
                   .recorded = *std::move(recorded),
                   .images = images,
                   .files = RequestFiles(folder.path, *form),
                   .open = *std::move(open),
                   .counts = {}});
  if (made->settings.model.empty()) {
    made->settings.model = made->format->default_model();
  }
  made->identity = {service.backend, made->settings.model,
                    SettingsText(*made->format, made->settings), "provider"};
  return made;
}

Status ExportCase(const DatasetFolder& dataset, const DatasetCase& c,
                  const RunOptions& options,
                  const advisor::MethodOptions& method,
                  const advisor::ReferencePool* pool, Exporter& exporter) {
  const Result<TerrainMap> map = ReadCaseMap(dataset, c, options.cost_model);
  if (!map.ok()) return map.error();
  const planner::LatticePlan baseline =
      planner::PlanOnLattice(*map, c.start, c.goal, options.lattice);
  if (!baseline.found()) {
    ++exporter.counts.without_baseline;
    return Done{};
  }
  LlmRequest request =
      advisor::PrepareCase(PlanningCaseOf(c, *map, baseline), method, pool)
          .request;
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    request.repeat = repeat;
    const Status added = exporter.Add(request);
    if (!added) return added;
  }
  return Done{};
}

}  // namespace

Result<ExportedBatch> ExportBatch(const DatasetFolder& dataset,
                                  const RunOptions& options,
                                  const advisor::LlmBackendOptions& llm,
                                  const BatchFolder& folder) {
  const Result<CaseSurvey> survey = SurveyCases(dataset, options.cases);
  if (!survey.ok()) return survey.error();
  const CaseList cases{dataset.folder, options.cases, {}};
  Result<CaseCursor> cursor = CaseCursor::Open(cases);
  if (!cursor.ok()) return cursor.error();
  const auto pool = advisor::LoadReferences(llm.references);
  if (!pool.ok()) return pool.error();
  auto exporter = MakeExporter(llm.service, folder);
  if (!exporter.ok()) return exporter.error();
  Exporter& out = **exporter;
  Progress progress("export", survey->num_selected);
  for (;;) {
    const Result<std::optional<DatasetCase>> c = cursor->Next();
    if (!c.ok()) return c.error();
    if (!c->has_value()) break;
    const Status written =
        ExportCase(dataset, **c, options, llm.method, pool->get(), out);
    if (!written) return written.error();
    progress.Advance();
  }
  const Status finished = out.files.Finish();
  if (!finished) return finished.error();
  // Last: with it the folder counts as a whole batch.
  const Status listed = out.open.Finish();
  if (!listed) return listed.error();
  out.counts.files = out.files.paths();
  return out.counts;
}

}  // namespace terra::benchmark
