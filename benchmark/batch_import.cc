#include <filesystem>
#include <fstream>
#include <unordered_map>
#include <utility>

#include <nlohmann/json.hpp>

#include "advisor/batch_format.h"
#include "advisor/recording.h"
#include "advisor/wire_json.h"
#include "base/utc.h"
#include "benchmark/batch.h"
#include "terrain/files/line_reader.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;
using advisor::LlmIdentity;
using advisor::WireFormat;

// A batch's results by request.
struct Results {
  std::unordered_map<std::string, advisor::LlmReply> replies;
  std::int64_t doubled = 0;
};

Status ReadBatchResults(const WireFormat& format, const std::string& path,
                        Results& results) {
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines.ok()) return lines.error();
  for (int number = 1;; ++number) {
    const Result<bool> taken = lines->Next();
    if (!taken.ok()) return taken.error();
    if (!*taken) return Done{};
    const std::string& line = lines->line();
    if (line.find_first_not_of(" \r\t\n") == std::string::npos) continue;
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

Result<OpenRequest> ParseOpenRequest(const std::string& line) {
  try {
    const auto json = advisor::ParsedOutside(line);
    if (json.is_discarded()) return Error{ErrorCode::kInvalid, "no JSON"};
    return OpenRequest{line,
                       json.at("request_hash").get<std::string>(),
                       advisor::IntegerAt<int>(json, "repeat"),
                       json.at("case_id").get<std::string>(),
                       {json.at("provider").get<std::string>(),
                        json.at("model_requested").get<std::string>(),
                        json.at("settings").get<std::string>(), "provider"}};
  } catch (const nlohmann::json::exception& error) {
    return Error{ErrorCode::kInvalid, advisor::JsonFault(error)};
  }
}

Result<std::vector<OpenRequest>> ReadOpenRequests(const std::string& folder) {
  const Error none{ErrorCode::kNotFound,
                   folder + ": no batch that `terra bench export-batch` wrote"};
  const std::string path = (fs::path(folder) / kOpenRequestsName).string();
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines.ok()) return none;
  std::vector<OpenRequest> requests;
  for (int number = 1;; ++number) {
    const Result<bool> taken = lines->Next();
    if (!taken.ok()) return taken.error();
    if (!*taken) break;
    Result<OpenRequest> request = ParseOpenRequest(lines->line());
    if (!request.ok()) {
      return Error{ErrorCode::kInvalid, path + ":" + std::to_string(number) +
                                            ": " + request.error().message};
    }
    requests.push_back(*std::move(request));
  }
  if (requests.empty()) return none;
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
  const auto line = advisor::AnswerRecord(request.line, reply, UtcNow());
  if (!line.ok()) return line.error();
  recording << *line;
  ++counts.imported;
  return Done{};
}

}  // namespace

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
  if (!*file) {
    return Error{ErrorCode::kUnavailable, recording + ": cannot be written"};
  }
  return counts;
}

}  // namespace terra::benchmark
