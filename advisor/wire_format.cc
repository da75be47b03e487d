#include "advisor/wire_format.h"

#include <algorithm>
#include <utility>

#include "advisor/wire_json.h"

namespace terra::advisor {
namespace {

using nlohmann::json;

/// Texts from outside are quoted up to this length.
constexpr std::size_t kMaxMessage = 300;

/// Parses without exceptions; a deep nesting would cost the parser memory in
/// proportion to the bytes only, which are capped.
json Parsed(std::string_view body) {
  return json::parse(body.begin(), body.end(), nullptr, false);
}

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

WireReply WireFormat::ReadReply(std::string_view body) const {
  WireReply bad;
  const json reply = Parsed(body);
  if (!reply.is_object()) {
    const bool stream = body.starts_with("data:") || body.starts_with("event:");
    bad.error = stream ? "the reply is an event stream, not asked for"
                       : "the reply is no JSON object";
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
  json reply = Parsed(body);
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
