#include "advisor/wire_format.h"

#include <algorithm>
#include <utility>

#include "advisor/event_stream.h"
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

/// Gateways report a failure behind them inside a success.
bool MayPass(const json& error) {
  const std::int64_t code = CountOr0(error, "code");
  return code == 408 || code == 429 || (code >= 500 && code < 600);
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
  WireReply bad;
  const json reply = ParsedOutside(body);
  if (!reply.is_object()) {
    bad.error = "the reply is no JSON object";
    return bad;
  }
  const json& error = MemberOf(reply, "error");
  // A provider that reports so inside a success says it in `status` as well.
  if (!error.is_null() && MemberOf(reply, "status").is_null()) {
    bad.error = ReadError(body).message;
    if (!bad.error.empty()) {
      bad.transient = MayPass(error);
      return bad;
    }
  }
  try {
    return ReadReplyJson(reply);
  } catch (const json::exception& wrong) {
    bad.error = "the reply has not the provider's form: " +
                std::string(wrong.what()).substr(0, kMaxMessage);
    return bad;
  }
}

WireError WireFormat::ReadError(std::string_view body) const {
  WireError result;
  json reply = ParsedOutside(body);
  if (reply.is_array() && reply.size() == 1) reply = json(reply[0]);
  const json& error = MemberOf(reply, "error");
  result.message =
      error.is_string() ? error.get<std::string>() : TextOr(error, "message");
  if (result.message.empty()) result.message = OtherMessage(reply, body);
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
