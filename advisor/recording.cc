#include "advisor/recording.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <functional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "advisor/encoding.h"
#include "advisor/wire_json.h"
#include "output/output_file.h"

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

// What the reply decides of a line; the rest is the request's.
void PutReply(const LlmReply& reply, const std::string& utc, json& line) {
  line["model_returned"] = reply.model;
  line["response_id"] = reply.response_id;
  line["utc"] = utc;
  line["status"] = StatusName(reply.status);
  line["answer_text"] = reply.text;
  line["error"] = reply.error;
  line["reply_body"] = reply.body;
  line["tokens_in"] = reply.usage.tokens_in;
  line["tokens_out"] = reply.usage.tokens_out;
  line["tokens_thinking"] = reply.usage.tokens_thinking;
  line["spend_usd"] = reply.spend_usd ? json(*reply.spend_usd) : json(nullptr);
  line["tries"] = reply.tries;
  line["t_llm_s"] = reply.timed ? json(reply.t_llm_s) : json(nullptr);
}

std::string Dumped(const json& line) {
  return line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string RecordKey(const std::string& request_hash, int repeat) {
  return request_hash + ":" + std::to_string(repeat);
}

Result<std::ofstream> OpenRecording(const std::string& path) {
  std::error_code failed;
  std::uintmax_t whole_lines = 0;
  std::uintmax_t size = 0;
  if (std::filesystem::is_regular_file(path, failed)) {
    std::ifstream before(path, std::ios::binary);
    for (std::string line; std::getline(before, line);) {
      size += line.size() + (before.eof() ? 0 : 1);
      if (!before.eof()) whole_lines = size;
    }
  }
  failed.clear();
  if (whole_lines < size) {
    std::filesystem::resize_file(path, whole_lines, failed);
  }
  std::ofstream file(path, std::ios::app | std::ios::binary);
  if (!file || failed) {
    return Error{ErrorCode::kUnavailable,
                 path + ": the recording cannot be written: " +
                     (failed ? failed.message() : std::strerror(errno))};
  }
  return file;
}

Status KeepImages(const LlmRequest& request, const std::string& folder) {
  for (const auto& picture : request.pictures) {
    const std::filesystem::path path =
        std::filesystem::path(folder) / (Sha256Hex(picture->png) + ".png");
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) continue;
    const Status written = WriteWholeFile(path.string(), picture->png);
    if (!written.ok()) return written;
  }
  return Done{};
}

std::string FormatRecord(const LlmIdentity& identity, const LlmRequest& request,
                         const LlmReply& reply, const std::string& utc) {
  json images = json::array();
  for (const auto& picture : request.pictures) {
    images.push_back(Sha256Hex(picture->png));
  }
  json line = {{"schema", kSchema},
               {"request_hash", RequestHash(identity, request)},
               {"repeat", request.repeat},
               {"case_id", request.case_id},
               {"method", request.method},
               {"prompt_id", request.prompt_id},
               {"provider", identity.provider},
               {"endpoint_class", identity.endpoint_class},
               {"model_requested", identity.model},
               {"settings", identity.settings},
               {"prompt_text", request.text},
               {"images", images}};
  PutReply(reply, utc, line);
  return Dumped(line);
}

Result<std::string> AnswerRecord(std::string_view open_line,
                                 const LlmReply& reply,
                                 const std::string& utc) {
  try {
    json line = json::parse(open_line);
    if (line.at("schema") != kSchema ||
        line.at("status") != StatusName(ReplyStatus::kNoAnswer)) {
      return Error{ErrorCode::kInvalid, "no open request"};
    }
    PutReply(reply, utc, line);
    return Dumped(line);
  } catch (const json::exception& error) {
    return Error{ErrorCode::kInvalid, JsonFault(error)};
  }
}

Result<RecordedCall> ParseRecord(std::string_view text) {
  try {
    const json line = json::parse(text);
    if (line.at("schema") != kSchema) {
      return Error{ErrorCode::kUnsupported, "a recording of another version"};
    }
    RecordedCall call;
    call.request_hash = line.at("request_hash").get<std::string>();
    call.repeat = IntegerAt<int>(line, "repeat");
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
    reply.usage = {IntegerAt<std::int64_t>(line, "tokens_in"),
                   IntegerAt<std::int64_t>(line, "tokens_out"),
                   IntegerAt<std::int64_t>(line, "tokens_thinking")};
    if (!line.at("spend_usd").is_null()) {
      reply.spend_usd = line.at("spend_usd").get<double>();
    }
    reply.tries = IntegerAt<int>(line, "tries");
    reply.timed = !line.at("t_llm_s").is_null();
    if (reply.timed) reply.t_llm_s = line.at("t_llm_s").get<double>();
    reply.recorded_at = line.at("utc").get<std::string>();
    return call;
  } catch (const json::exception& error) {
    return Error{ErrorCode::kInvalid, JsonFault(error)};
  }
}

Status ForEachRecordedCall(const std::string& path, const TakeCall& take) {
  std::ifstream file(path, std::ios::binary);
  std::error_code failed;
  if (!file || std::filesystem::is_directory(path, failed)) {
    return Error{ErrorCode::kNotFound, path + ": no such recording"};
  }
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::string at = path + ":" + std::to_string(number) + ": ";
    auto call = ParseRecord(line);
    if (!call) {
      if (file.eof()) break;  // Killed while it was writing.
      return Error{call.error().code, at + call.error().message};
    }
    const Status taken = take(*std::move(call), at);
    if (!taken) return taken;
  }
  return Done{};
}

Result<std::unordered_set<std::string>> ReadRecordKeys(
    const std::string& path) {
  std::unordered_set<std::string> keys;
  std::error_code failed;
  if (!std::filesystem::exists(path, failed)) return keys;
  const Status read =
      ForEachRecordedCall(path, [&keys](RecordedCall call, const std::string&) {
        keys.insert(RecordKey(call.request_hash, call.repeat));
        return Status(Done{});
      });
  if (!read) return read.error();
  return keys;
}

}  // namespace terra::advisor
