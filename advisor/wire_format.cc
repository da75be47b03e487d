#include "advisor/wire_format.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "advisor/answer_parser.h"
#include "advisor/ascii.h"
#include "advisor/event_stream.h"
#include "advisor/thinking.h"
#include "advisor/wire_json.h"

namespace terra::advisor {
namespace {

using nlohmann::json;

/// Texts from outside are quoted up to this length.
constexpr std::size_t kMaxMessage = 300;

/// What a server that is no provider's may write instead of the provider's
/// error: a message of its own, or a line of plain text. Not a page of HTML.
std::string OtherMessage(const json& reply, std::string_view body) {
  if (reply.is_discarded()) {
    const std::size_t first = body.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos || body[first] == '<') return "";
    body.remove_prefix(first);
    return std::string(body.substr(0, body.find('\n')));
  }
  const json& detail = MemberOf(reply, "detail");
  if (detail.is_string()) return detail.get<std::string>();
  if (detail.is_array() && !detail.empty()) return TextOr(detail[0], "msg");
  return TextOr(reply, "message");
}

/// Is that an error, or only room for one?
bool IsFailure(const json& error) {
  if (error.is_string()) return error != "";
  return error.is_object() ? !error.empty() : error == true;
}

/// A provider whose replies have a status says there that one failed.
bool HasOwnStatus(const json& reply) {
  const std::string status = TextOr(reply, "status");
  return status == "completed" || status == "incomplete" ||
         status == "failed" || status == "cancelled";
}

/// Gateways report a failure behind them inside a success: at the top, or where
/// the answer should be. Null where there is none.
const json& FailureInside(const json& reply) {
  static const json kNone;
  const json& error = MemberOf(reply, "error");
  if (IsFailure(error) && !HasOwnStatus(reply)) return error;
  for (const char* answers : {"choices", "candidates"}) {
    const json& list = MemberOf(reply, answers);
    if (!list.is_array() || list.empty()) continue;
    const json& inner = MemberOf(list.front(), "error");
    if (IsFailure(inner)) return inner;
  }
  return kNone;
}

/// The code of an error as a status of HTTP; 0 where it is none.
std::int64_t StatusIn(const json& error) {
  const std::string text = TextOr(error, "code");
  std::int64_t status = CountOr0(error, "code");
  std::from_chars(text.data(), text.data() + text.size(), status);
  return status;
}

/// May the failure pass on its own, as the providers name such?
bool MayPass(const json& error) {
  constexpr std::array<std::string_view, 14> kPassing = {
      "api_error",        "deadline_exceeded",     "internal",
      "internal_error",   "internal_server_error", "overloaded",
      "overloaded_error", "rate_limit_error",      "rate_limit_exceeded",
      "server_error",     "resource_exhausted",    "timeout_error",
      "unavailable",      "unavailable_error"};
  const std::int64_t status = StatusIn(error);
  if (status == 408 || status == 429) return true;
  if (status >= 500 && status < 600) return status != 501;
  if (status != 0) return false;
  for (const char* key : {"code", "type", "status"}) {
    const std::string word = Lowered(TextOr(error, key));
    if (std::find(kPassing.begin(), kPassing.end(), word) != kPassing.end()) {
      return true;
    }
  }
  return false;
}

/// "502", "server_error", ...; empty where an error has no code.
std::string CodeIn(const json& error) {
  const std::int64_t number = CountOr0(error, "code");
  return number == 0 ? TextOr(error, "code") : std::to_string(number);
}

WireReply WrongForm(std::string why) {
  WireReply bad;
  bad.wrong_form = true;
  bad.error = std::move(why);
  return bad;
}

}  // namespace

std::optional<std::string> WireFormat::Whole(std::string body) const {
  if (!IsEventStream(body)) return body;
  const auto events = ReadEventStream(body);
  if (!events) return std::nullopt;
  const auto failed =
      std::find_if(events->begin(), events->end(), [](const json& event) {
        return !MemberOf(event, "error").is_null();
      });
  const json whole = failed != events->end() ? *failed : JoinEvents(*events);
  if (whole.is_null()) return std::nullopt;
  return whole.dump(-1, ' ', false, json::error_handler_t::replace);
}

WireReply WireFormat::ReadReply(std::string_view body) const {
  const json reply = ParsedOutside(body);
  if (!reply.is_object()) return WrongForm("the reply is no JSON object");
  if (const json& failure = FailureInside(reply); !failure.is_null()) {
    return FailureOf(failure, OtherMessage(reply, body));
  }
  WireReply read;
  try {
    read = ReadReplyJson(reply);
  } catch (const json::exception& wrong) {
    return WrongForm("the reply has not the form of " +
                     std::string(provider()) + ": " +
                     JsonFault(wrong).substr(0, kMaxMessage));
  }
  std::string answer = WithoutThinking(read.text);
  read.has_thinking = read.has_thinking || answer.size() < read.text.size();
  read.text = std::move(answer);
  if (read.status == ReplyStatus::kAnswered && read.error.empty() &&
      read.has_thinking && IsBlankAnswer(read.text)) {
    read.error =
        "the model thought and gave no answer: allow more output tokens "
        "(--max-output-tokens) or less thinking (--effort, or the server's "
        "own option)";
  }
  return read;
}

WireReply WireFormat::FailureOf(const json& error,
                                const std::string& otherwise) const {
  WireError read = ReadErrorValue(error);
  if (read.message.empty()) read.message = otherwise.substr(0, kMaxMessage);
  const std::string code = CodeIn(error);
  WireReply failed;
  failed.error = !read.message.empty() && !code.empty()
                     ? code + ": " + read.message
                     : code + read.message;
  if (failed.error.empty()) failed.error = "the server reports an error";
  failed.transient = !read.final && MayPass(error);
  failed.retry_after_s = read.retry_after_s;
  return failed;
}

WireError WireFormat::ReadError(std::string_view body) const {
  json reply = ParsedOutside(body);
  if (reply.is_array() && reply.size() == 1) reply = json(reply[0]);
  WireError result = ReadErrorValue(MemberOf(reply, "error"));
  if (result.message.empty()) {
    result.message = OtherMessage(reply, body).substr(0, kMaxMessage);
  }
  return result;
}

WireError WireFormat::ReadErrorValue(const json& error) const {
  WireError result;
  result.message =
      error.is_string() ? error.get<std::string>() : TextOr(error, "message");
  if (error.is_object()) {
    try {
      ReadErrorJson(error, result);
    } catch (const json::exception&) {
      // The message is all that can be had from it.
    }
  }
  result.message.resize(std::min(result.message.size(), kMaxMessage));
  return result;
}

std::string SettingsText(const WireFormat& format,
                         const GenerationSettings& settings) {
  json text = {{"max_output_tokens", settings.max_output_tokens}};
  if (format.provider() != "chat") text["effort"] = settings.effort;
  if (format.provider() == "openai") {
    text["image_detail"] = settings.image_detail;
  }
  return text.dump();
}

std::unique_ptr<WireFormat> MakeWireFormat(std::string_view provider) {
  for (auto make : {MakeOpenAiFormat, MakeGeminiFormat, MakeAnthropicFormat,
                    MakeChatFormat}) {
    auto format = make();
    if (format->provider() == provider) return format;
  }
  return nullptr;
}

}  // namespace terra::advisor
