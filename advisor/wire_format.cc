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

}  // namespace

WireReply WireFormat::ReadReply(std::string_view body) const {
  WireReply bad;
  const json reply = Parsed(body);
  if (!reply.is_object()) {
    bad.error = "the reply is no JSON object";
    return bad;
  }
  try {
    return ReadReplyJson(reply);
  } catch (const json::exception& error) {
    bad.error = "the reply has not the provider's form: " +
                std::string(error.what()).substr(0, kMaxMessage);
    return bad;
  }
}

WireError WireFormat::ReadError(std::string_view body) const {
  WireError result;
  const json reply = Parsed(body);
  const json& error = MemberOf(reply, "error");
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
