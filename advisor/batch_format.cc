#include "advisor/batch_format.h"

#include <array>
#include <utility>

#include "advisor/wire_json.h"
#include "terrain/require.h"

namespace terra::advisor {
namespace {

using nlohmann::json;

constexpr std::size_t kMb = 1'000'000;

// Gemini documents bytes only; the count keeps files handy.
constexpr std::array<BatchForm, 3> kForms = {{
    {"openai", ".jsonl", "", "\n", "\n", 50'000, 200 * kMb},
    {"anthropic", ".json", "{\"requests\":[\n", ",\n", "\n]}\n", 100'000,
     256 * kMb},
    {"gemini", ".jsonl", "", "\n", "\n", 100'000, 2'000 * kMb},
}};

constexpr const char* IdField(std::string_view provider) {
  return provider == "gemini" ? "key" : "custom_id";
}

std::string Dumped(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

LlmReply ReplyOf(const WireFormat& format, const json& body) {
  LlmReply reply;
  reply.body = Dumped(body);
  WireReply wire = format.ReadReply(reply.body);
  reply.status = wire.status;
  reply.reason = reply.came() ? NoAnswer::kNone : NoAnswer::kBadReply;
  reply.text = std::move(wire.text);
  reply.error = std::move(wire.error);
  reply.model = std::move(wire.model);
  reply.response_id = std::move(wire.response_id);
  reply.usage = wire.usage;
  return reply;
}

LlmReply Failed(std::string why) {
  LlmReply reply;
  reply.reason = NoAnswer::kHttpStatus;
  reply.error = why.empty() ? "failed without a word" : std::move(why);
  return reply;
}

/// The message of an error object, or its code.
std::string ErrorText(const WireFormat& format, const json& error) {
  const std::string message =
      format.ReadError(Dumped(json{{"error", error}})).message;
  return message.empty() ? TextOr(error, "code") : message;
}

// {"response": {"status_code", "body"}, "error": null or {"code", "message"}}
LlmReply OpenAiReply(const WireFormat& format, const json& line) {
  const json& error = MemberOf(line, "error");
  if (!error.is_null()) return Failed(ErrorText(format, error));
  const json& response = line.at("response");
  const json& body = response.at("body");
  const int status = IntegerAt<int>(response, "status_code");
  if (status >= 200 && status < 300) return ReplyOf(format, body);
  LlmReply failed = Failed("HTTP " + std::to_string(status) + ": " +
                           ErrorText(format, MemberOf(body, "error")));
  failed.http_status = status;
  return failed;
}

// {"result": {"type": "succeeded", "message"} or {"type": "errored", "error":
// {"error": {...}}} or {"type": "canceled"} or {"type": "expired"}}
LlmReply AnthropicReply(const WireFormat& format, const json& line) {
  const json& result = line.at("result");
  const std::string type = result.at("type").get<std::string>();
  if (type == "succeeded") return ReplyOf(format, result.at("message"));
  if (type == "errored") {
    const json& error = result.at("error");
    const json& inner = MemberOf(error, "error");
    return Failed(ErrorText(format, inner.is_null() ? error : inner));
  }
  return Failed(type);
}

// {"response": {...}} or {"error": {"code", "message"}}
LlmReply GeminiReply(const WireFormat& format, const json& line) {
  const json& error = MemberOf(line, "error");
  if (!error.is_null()) return Failed(ErrorText(format, error));
  return ReplyOf(format, line.at("response"));
}

}  // namespace

const BatchForm* FindBatchForm(std::string_view provider) {
  for (const BatchForm& form : kForms) {
    if (form.provider == provider) return &form;
  }
  return nullptr;
}

std::string BatchId(const std::string& request_hash, int repeat) {
  return request_hash + "-" + std::to_string(repeat);
}

std::string BatchItem(const WireFormat& format, const std::string& id,
                      const LlmRequest& request,
                      const GenerationSettings& settings) {
  const std::string_view provider = format.provider();
  TERRA_REQUIRE(FindBatchForm(provider) != nullptr);
  json item = {{IdField(provider), id}};
  const char* body = provider == "openai"      ? "body"
                     : provider == "anthropic" ? "params"
                                               : "request";
  item[body] = format.Body(request, settings);
  if (provider == "openai") {
    item["method"] = "POST";
    item["url"] = format.Path(settings);
  }
  return Dumped(item);
}

Result<BatchResult> ReadBatchResult(const WireFormat& format,
                                    std::string_view text) {
  const std::string_view provider = format.provider();
  TERRA_REQUIRE(FindBatchForm(provider) != nullptr);
  try {
    const json line = ParsedOutside(text);
    if (line.is_discarded()) {
      return Error{ErrorCode::kInvalid, "no JSON in a line of a results file"};
    }
    BatchResult result;
    result.id = line.at(IdField(provider)).get<std::string>();
    result.reply = provider == "openai"      ? OpenAiReply(format, line)
                   : provider == "anthropic" ? AnthropicReply(format, line)
                                             : GeminiReply(format, line);
    result.reply.tries = 1;
    result.reply.timed = false;
    return result;
  } catch (const json::exception& error) {
    return Error{ErrorCode::kInvalid, "no line of a results file of " +
                                          std::string(provider) + ": " +
                                          JsonFault(error)};
  }
}

}  // namespace terra::advisor
