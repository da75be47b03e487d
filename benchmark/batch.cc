#include "benchmark/batch.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <nlohmann/json.hpp>

#include "advisor/batch_format.h"
#include "advisor/llm_methods.h"
#include "advisor/recording.h"
#include "advisor/wire_json.h"
#include "benchmark/llm_method.h"
#include "benchmark/progress.h"
#include "planner/coarse_lattice.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;
using advisor::BatchForm;
using advisor::LlmIdentity;
using advisor::LlmRequest;
using advisor::WireFormat;

constexpr const char* kOpenName = "open.jsonl";

Error CannotWrite(const std::string& path) {
  return {ErrorCode::kUnavailable, path + ": cannot be written"};
}

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
    Put(count_ == 0 ? form_.head : form_.separator);
    Put(item);
    ++count_;
    return file_ ? Status(Done{}) : CannotWrite(paths_.back());
  }

  Status Finish() {
    if (count_ == 0) return Done{};
    Put(form_.tail);
    file_.close();
    count_ = bytes_ = 0;
    return file_ ? Status(Done{}) : CannotWrite(paths_.back());
  }

  const std::vector<std::string>& paths() const { return paths_; }

 private:
  void Put(std::string_view text) {
    if (!file_.is_open()) {
      std::array<char, 32> name{};
      std::snprintf(name.data(), name.size(), "requests-%03zu",
                    paths_.size() + 1);
      paths_.push_back((fs::path(folder_) / name.data()).string() +
                       std::string(form_.extension));
      file_.open(paths_.back(), std::ios::binary | std::ios::trunc);
    }
    file_ << text;
    bytes_ += text.size();
  }

  const std::string folder_;
  const BatchForm& form_;
  std::vector<std::string> paths_;
  std::ofstream file_;
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
  std::ofstream open;
  ExportedBatch counts;

  Status Add(const LlmRequest& request) {
    const std::string hash = advisor::RequestHash(identity, request);
    if (recorded.contains(advisor::RecordKey(hash, request.repeat))) {
      ++counts.left_out;
      return Done{};
    }
    if (!images.empty()) advisor::KeepImages(request, images);
    open << advisor::FormatRecord(identity, request, {}, advisor::UtcNow());
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
  const std::string open_path = (fs::path(folder.path) / kOpenName).string();
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
  auto made = std::unique_ptr<Exporter>(
      new Exporter{.format = advisor::MakeWireFormat(service.backend),
                   .settings = service.provider.settings,
                   .identity = {},
                   .recorded = *std::move(recorded),
                   .images = images,
                   .files = RequestFiles(folder.path, *form),
                   .open = std::ofstream(open_path, std::ios::binary),
                   .counts = {}});
  if (failed || !made->open) return CannotWrite(folder.path);
  if (made->settings.model.empty()) {
    made->settings.model = made->format->default_model();
  }
  made->identity = {service.backend, made->settings.model,
                    SettingsText(*made->format, made->settings), "provider"};
  return made;
}

Status ExportCase(const Dataset& dataset, const DatasetCase& c,
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

// A batch's results by request.
struct Results {
  std::unordered_map<std::string, advisor::LlmReply> replies;
  std::int64_t doubled = 0;
};

Status ReadBatchResults(const WireFormat& format, const std::string& path,
                        Results& results) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{ErrorCode::kNotFound, path + ": no such file"};
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.find_first_not_of(" \r\t") == std::string::npos) continue;
    auto read = advisor::ReadBatchResult(format, line);
    if (!read.ok()) {
      return Error{read.error().code, path + ":" + std::to_string(number) +
                                          ": " + read.error().message};
    }
    const bool added =
        results.replies.emplace(std::move(read->id), std::move(read->reply))
            .second;
    if (!added) ++results.doubled;
  }
  return Done{};
}

// An open request, as far as an import has to know it.
struct OpenRequest {
  std::string line;
  std::string hash;
  int repeat = 0;
  std::string case_id;
  LlmIdentity identity;

  std::string batch_id() const { return advisor::BatchId(hash, repeat); }
};

Result<std::vector<OpenRequest>> ReadOpenRequests(const std::string& folder) {
  const std::string path = (fs::path(folder) / kOpenName).string();
  std::ifstream file(path, std::ios::binary);
  std::vector<OpenRequest> requests;
  try {
    for (std::string line; std::getline(file, line);) {
      const auto json = nlohmann::json::parse(line);
      requests.push_back(
          {line,
           json.at("request_hash").get<std::string>(),
           advisor::IntegerAt<int>(json, "repeat"),
           json.at("case_id").get<std::string>(),
           {json.at("provider").get<std::string>(),
            json.at("model_requested").get<std::string>(),
            json.at("settings").get<std::string>(), "provider"}});
    }
  } catch (const nlohmann::json::exception& error) {
    return Error{ErrorCode::kInvalid, path + ": " + error.what()};
  }
  if (requests.empty()) {
    return Error{ErrorCode::kNotFound,
                 folder + ": no batch that `terra bench export-batch` wrote"};
  }
  return requests;
}

// Adds one request's answer to the recording, or counts why not.
Status KeepResult(const OpenRequest& request, Results& results,
                  const advisor::PriceTable& prices, std::ofstream& recording,
                  ImportedBatch& counts) {
  const auto at = results.replies.find(request.batch_id());
  if (at == results.replies.end()) {
    ++counts.missing;
    return Done{};
  }
  advisor::LlmReply& reply = at->second;
  if (!reply.came()) {
    ++counts.failed;
    counts.failures.push_back(request.case_id + ": " + reply.error);
    return Done{};
  }
  reply.spend_usd = prices.Spend(request.identity, reply);
  const auto line =
      advisor::AnswerRecord(request.line, reply, advisor::UtcNow());
  if (!line.ok()) return line.error();
  recording << *line;
  ++counts.imported;
  return Done{};
}

}  // namespace

Result<ExportedBatch> ExportBatch(const Dataset& dataset,
                                  const RunOptions& options,
                                  const advisor::LlmBackendOptions& llm,
                                  const BatchFolder& folder) {
  const auto pool = advisor::LoadReferences(llm.references);
  if (!pool.ok()) return pool.error();
  auto exporter = MakeExporter(llm.service, folder);
  if (!exporter.ok()) return exporter.error();
  Exporter& out = **exporter;
  const std::unordered_set<std::string> chosen(options.cases.begin(),
                                               options.cases.end());
  Progress progress(
      "export", static_cast<std::int64_t>(chosen.empty() ? dataset.cases.size()
                                                         : chosen.size()));
  for (const DatasetCase& c : dataset.cases) {
    if (!chosen.empty() && !chosen.contains(c.case_id)) continue;
    const Status written =
        ExportCase(dataset, c, options, llm.method, pool->get(), out);
    if (!written) return written.error();
    progress.Advance();
  }
  const Status finished = out.files.Finish();
  if (!finished) return finished.error();
  out.open.close();
  if (!out.open) return CannotWrite(folder.path);
  out.counts.files = out.files.paths();
  return out.counts;
}

Result<ImportedBatch> ImportBatch(const std::string& folder,
                                  const std::vector<std::string>& result_files,
                                  const std::string& recording,
                                  const advisor::PriceTable& prices) {
  const auto requests = ReadOpenRequests(folder);
  if (!requests.ok()) return requests.error();
  const auto format =
      advisor::MakeWireFormat(requests->front().identity.provider);
  if (format == nullptr ||
      advisor::FindBatchForm(format->provider()) == nullptr) {
    return Error{ErrorCode::kInvalid, folder + ": a batch of no provider"};
  }
  Results results;
  for (const std::string& path : result_files) {
    const Status read = ReadBatchResults(*format, path, results);
    if (!read) return read.error();
  }
  const auto known = advisor::ReadRecordKeys(recording);
  if (!known.ok()) return known.error();
  auto file = advisor::OpenRecording(recording);
  if (!file.ok()) return file.error();

  ImportedBatch counts;
  counts.doubled = results.doubled;
  counts.foreign = static_cast<std::int64_t>(results.replies.size());
  for (const OpenRequest& request : *requests) {
    if (results.replies.contains(request.batch_id())) --counts.foreign;
    if (known->contains(advisor::RecordKey(request.hash, request.repeat))) {
      ++counts.known;
      continue;
    }
    const Status kept = KeepResult(request, results, prices, *file, counts);
    if (!kept) return kept.error();
  }
  file->close();
  if (!*file) return CannotWrite(recording);
  return counts;
}

}  // namespace terra::benchmark
