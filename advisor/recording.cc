#include "advisor/recording.h"

#include <ctime>
#include <filesystem>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "advisor/encoding.h"

namespace terra::advisor {
namespace {

using nlohmann::json;

constexpr int kSchema = 1;

std::string StatusName(ReplyStatus status) {
  switch (status) {
    case ReplyStatus::kAnswered:
      return "answered";
    case ReplyStatus::kTruncated:
      return "truncated";
    case ReplyStatus::kRefused:
      return "refused";
    case ReplyStatus::kNoAnswer:
      break;
  }
  return "no_answer";
}

ReplyStatus StatusOf(const std::string& name) {
  for (const ReplyStatus status :
       {ReplyStatus::kAnswered, ReplyStatus::kTruncated,
        ReplyStatus::kRefused}) {
    if (StatusName(status) == name) return status;
  }
  return ReplyStatus::kNoAnswer;
}

std::string UtcNow() {
  const std::time_t now = std::time(nullptr);
  tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  const std::size_t size =
      std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return std::string(text, size);
}

std::string Key(const std::string& hash, int repeat) {
  return hash + ":" + std::to_string(repeat);
}

}  // namespace

std::string FormatRecord(const LlmIdentity& identity, const LlmRequest& request,
                         const LlmReply& reply, const std::string& utc) {
  json images = json::array();
  for (const auto& picture : request.pictures) {
    images.push_back(Sha256Hex(picture->png));
  }
  const json line = {
      {"schema", kSchema},
      {"request_hash", RequestHash(identity, request)},
      {"repeat", request.repeat},
      {"case_id", request.case_id},
      {"method", request.method},
      {"prompt_id", request.prompt_id},
      {"provider", identity.provider},
      {"endpoint_class", identity.endpoint_class},
      {"model_requested", identity.model},
      {"model_returned", reply.model},
      {"response_id", reply.response_id},
      {"utc", utc},
      {"settings", identity.settings},
      {"prompt_text", request.text},
      {"images", images},
      {"status", StatusName(reply.status)},
      {"answer_text", reply.text},
      {"error", reply.error},
      {"reply_body", reply.body},
      {"tokens_in", reply.usage.tokens_in},
      {"tokens_out", reply.usage.tokens_out},
      {"tokens_thinking", reply.usage.tokens_thinking},
      {"spend_usd", reply.spend_usd ? json(*reply.spend_usd) : json(nullptr)},
      {"tries", reply.tries},
      {"t_llm_s", reply.t_llm_s}};
  return line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

Result<RecordedCall> ParseRecord(std::string_view text) {
  try {
    const json line = json::parse(text);
    if (line.at("schema") != kSchema) {
      return Error{ErrorCode::kUnsupported, "a recording of another version"};
    }
    RecordedCall call;
    call.request_hash = line.at("request_hash").get<std::string>();
    call.repeat = line.at("repeat").get<int>();
    call.identity = {line.at("provider").get<std::string>(),
                     line.at("model_requested").get<std::string>(),
                     line.at("settings").get<std::string>(),
                     line.at("endpoint_class").get<std::string>()};
    LlmReply& reply = call.reply;
    reply.status = StatusOf(line.at("status").get<std::string>());
    if (!reply.came()) {
      return Error{ErrorCode::kInvalid, "no reply in it"};
    }
    reply.text = line.at("answer_text").get<std::string>();
    reply.error = line.at("error").get<std::string>();
    reply.body = line.at("reply_body").get<std::string>();
    reply.model = line.at("model_returned").get<std::string>();
    reply.response_id = line.at("response_id").get<std::string>();
    reply.usage = {line.at("tokens_in").get<std::int64_t>(),
                   line.at("tokens_out").get<std::int64_t>(),
                   line.at("tokens_thinking").get<std::int64_t>()};
    if (!line.at("spend_usd").is_null()) {
      reply.spend_usd = line.at("spend_usd").get<double>();
    }
    reply.tries = line.at("tries").get<int>();
    reply.t_llm_s = line.at("t_llm_s").get<double>();
    reply.recorded_at = line.at("utc").get<std::string>();
    return call;
  } catch (const json::exception& error) {
    return Error{ErrorCode::kInvalid, error.what()};
  }
}

Result<std::unique_ptr<LlmClient>> RecordingClient::Create(
    std::unique_ptr<LlmClient> inner, const std::string& path, bool images) {
  std::string image_folder;
  std::error_code failed;
  if (images) {
    image_folder = path + ".images";
    std::filesystem::create_directories(image_folder, failed);
  }
  std::ofstream file(path, std::ios::app | std::ios::binary);
  if (!file || failed) {
    return Error{ErrorCode::kUnavailable,
                 path + ": the recording cannot be written"};
  }
  return std::unique_ptr<LlmClient>(std::make_unique<RecordingClient>(
      std::move(inner), std::move(file), std::move(image_folder)));
}

RecordingClient::RecordingClient(std::unique_ptr<LlmClient> inner,
                                 std::ofstream file, std::string image_folder)
    : inner_(std::move(inner)),
      file_(std::move(file)),
      image_folder_(std::move(image_folder)) {}

LlmReply RecordingClient::Ask(const LlmRequest& request, std::stop_token stop) {
  LlmReply reply = inner_->Ask(request, stop);
  if (reply.came()) {
    KeepImages(request);
    file_ << FormatRecord(identity(), request, reply, UtcNow()) << std::flush;
    if (!file_) {
      // The answer is still good; that it was not kept must not stay unseen.
      reply.error += reply.error.empty() ? "" : "; ";
      reply.error += "the recording could not be written";
      file_.clear();
    }
  }
  return reply;
}

void RecordingClient::KeepImages(const LlmRequest& request) {
  if (image_folder_.empty()) {
    return;
  }
  for (const auto& picture : request.pictures) {
    const std::filesystem::path path = std::filesystem::path(image_folder_) /
                                       (Sha256Hex(picture->png) + ".png");
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
      std::ofstream(path, std::ios::binary) << picture->png;
    }
  }
}

Result<std::unique_ptr<LlmClient>> ReplayClient::Create(
    const std::string& path, const std::string& model) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return Error{ErrorCode::kNotFound, path + ": no such recording"};
  }
  std::optional<LlmIdentity> identity;
  std::unordered_map<std::string, LlmReply> replies;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const auto at = path + ":" + std::to_string(number) + ": ";
    auto call = ParseRecord(line);
    if (!call) {
      if (file.eof()) break;  // Killed while it was writing.
      return Error{call.error().code, at + call.error().message};
    }
    if (!model.empty() && call->identity.model != model) continue;
    if (!identity) identity = call->identity;
    if (identity->model != call->identity.model ||
        identity->settings != call->identity.settings) {
      return Error{ErrorCode::kInvalid,
                   at + "another model or other settings than before; choose "
                        "one with --model, or split the file"};
    }
    replies[Key(call->request_hash, call->repeat)] =
        std::move(call.value().reply);
  }
  if (!identity) {
    return Error{
        ErrorCode::kNotFound,
        path + ": no recorded call" + (model.empty() ? "" : " of ") + model};
  }
  return std::unique_ptr<LlmClient>(
      std::make_unique<ReplayClient>(*std::move(identity), std::move(replies)));
}

ReplayClient::ReplayClient(LlmIdentity identity,
                           std::unordered_map<std::string, LlmReply> replies)
    : identity_(std::move(identity)), replies_(std::move(replies)) {}

LlmReply ReplayClient::Ask(const LlmRequest& request, std::stop_token) {
  const std::string hash = RequestHash(identity_, request);
  const auto at = replies_.find(Key(hash, request.repeat));
  if (at != replies_.end()) {
    return at->second;
  }
  LlmReply none;
  none.reason = NoAnswer::kNotRecorded;
  none.error = "the recording has no request " + hash + ", repeat " +
               std::to_string(request.repeat);
  return none;
}

}  // namespace terra::advisor
