// Anthropic Messages: POST /v1/messages.
#include <algorithm>

#include "advisor/wire_format.h"
#include "advisor/wire_json.h"
#include "base/base64.h"

namespace terra::advisor {
namespace {

using nlohmann::json;

class AnthropicFormat : public WireFormat {
 public:
  std::string_view provider() const override { return "anthropic"; }
  std::string_view default_base_url() const override {
    return "https://api.anthropic.com";
  }
  std::string_view default_model() const override { return "claude-opus-4-8"; }
  std::string_view key_variable() const override { return "ANTHROPIC_API_KEY"; }

  std::string Path(const GenerationSettings&) const override {
    return "/v1/messages";
  }

  HeaderList Headers(const GenerationSettings& settings,
                     const std::string& key) const override {
    const auto auth =
        settings.anthropic_bearer
            ? std::pair<std::string, std::string>("authorization",
                                                  "Bearer " + key)
            : std::pair<std::string, std::string>("x-api-key", key);
    return {auth, {"anthropic-version", settings.anthropic_version}};
  }

  json Body(const LlmRequest& request,
            const GenerationSettings& settings) const override {
    json content = json::array();
    for (const auto& picture : request.pictures) {
      content.push_back({{"type", "image"},
                         {"source",
                          {{"type", "base64"},
                           {"media_type", "image/png"},
                           {"data", Base64Encode(picture->png)}}}});
    }
    content.push_back({{"type", "text"}, {"text", request.text}});
    json body = {{"model", settings.model},
                 {"max_tokens", settings.max_output_tokens},
                 {"messages", {{{"role", "user"}, {"content", content}}}}};
    if (!settings.effort.empty()) {
      body["thinking"] = {{"type", "adaptive"}};
      body["output_config"] = {{"effort", settings.effort}};
    }
    return body;
  }

 protected:
  WireReply ReadReplyJson(const json& reply) const override {
    WireReply result;
    result.model = TextOr(reply, "model");
    result.response_id = TextOr(reply, "id");
    const json& usage = MemberOf(reply, "usage");
    result.usage = {
        CountOr0(usage, "input_tokens") +
            CountOr0(usage, "cache_creation_input_tokens") +
            CountOr0(usage, "cache_read_input_tokens"),
        CountOr0(usage, "output_tokens"),
        CountOr0(MemberOf(usage, "output_tokens_details"), "thinking_tokens")};
    // Thinking blocks may come first; only text blocks are the answer.
    const json& content = reply.at("content");
    result.text = ContentText(content, {"text"});
    result.has_thinking =
        std::any_of(content.begin(), content.end(), [](const json& block) {
          return TextOr(block, "type").ends_with("thinking");
        });
    const std::string stop = TextOr(reply, "stop_reason");
    if (stop == "max_tokens" || stop == "model_context_window_exceeded") {
      result.status = ReplyStatus::kTruncated;
      result.error = stop;
    } else if (stop == "refusal") {
      result.status = ReplyStatus::kRefused;
      result.error = TextOr(MemberOf(reply, "stop_details"), "explanation",
                            "refused without explanation");
    } else {
      result.status = ReplyStatus::kAnswered;
    }
    return result;
  }

  json JoinEvents(const std::vector<json>& events) const override {
    json reply = json::object();
    json usage = json::object();
    std::string text;
    for (const json& event : events) {
      const json& message = MemberOf(event, "message");
      TakeOver(reply, message);
      TakeOver(usage, MemberOf(message, "usage"));
      TakeOver(usage, MemberOf(event, "usage"));
      text += TextOr(MemberOf(event, "content_block"), "text");
      const json& delta = MemberOf(event, "delta");
      if (TextOr(event, "type") == "message_delta") TakeOver(reply, delta);
      if (TextOr(delta, "type") == "text_delta") text += TextOr(delta, "text");
    }
    if (TextOr(reply, "stop_reason").empty()) return nullptr;
    reply["usage"] = usage;
    reply["content"] = {{{"type", "text"}, {"text", text}}};
    return reply;
  }

  void ReadErrorJson(const json& error, WireError& result) const override {
    const std::string code = TextOr(MemberOf(error, "details"), "error_code");
    result.final = code == "enforced_spend_limit_reached" ||
                   code == "contract_spend_limit_reached";
  }
};

}  // namespace

std::unique_ptr<WireFormat> MakeAnthropicFormat() {
  return std::make_unique<AnthropicFormat>();
}

}  // namespace terra::advisor
