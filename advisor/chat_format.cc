// OpenAI-compatible chat: POST /v1/chat/completions (llama.cpp, Ollama, vLLM).
#include "advisor/wire_format.h"
#include "advisor/wire_json.h"

namespace terra::advisor {
namespace {

using nlohmann::json;

/// Models that think may leave `<think>...</think>` before the answer. An
/// unclosed one means that the answer never began.
std::string WithoutThinking(std::string text) {
  constexpr std::string_view kOpen = "<think>";
  constexpr std::string_view kClose = "</think>";
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos ||
      text.compare(first, kOpen.size(), kOpen) != 0) {
    return text;
  }
  const std::size_t close = text.find(kClose, first);
  return close == std::string::npos ? "" : text.substr(close + kClose.size());
}

class ChatFormat : public WireFormat {
 public:
  std::string_view provider() const override { return "chat"; }
  std::string_view default_base_url() const override {
    return "http://127.0.0.1:8080";
  }
  std::string_view default_model() const override { return "local-model"; }
  std::string_view key_variable() const override {
    return "TERRA_CHAT_API_KEY";
  }
  bool key_optional() const override { return true; }

  std::string Path(const GenerationSettings&) const override {
    return "/v1/chat/completions";
  }

  HeaderList Headers(const GenerationSettings&,
                     const std::string& key) const override {
    if (key.empty()) return {};
    return {{"authorization", "Bearer " + key}};
  }

  /// Effort is not sent: few of these servers know it, and some refuse it.
  json Body(const LlmRequest& request,
            const GenerationSettings& settings) const override {
    json content = json::array();
    for (const auto& picture : request.pictures) {
      content.push_back(
          {{"type", "image_url"}, {"image_url", {{"url", DataUri(*picture)}}}});
    }
    content.push_back({{"type", "text"}, {"text", request.text}});
    return {{"model", settings.model},
            {"max_tokens", settings.max_output_tokens},
            {"messages", {{{"role", "user"}, {"content", content}}}}};
  }

 protected:
  WireReply ReadReplyJson(const json& reply) const override {
    WireReply result;
    result.model = TextOr(reply, "model");
    result.response_id = TextOr(reply, "id");
    const json& usage = MemberOf(reply, "usage");
    result.usage = {CountOr0(usage, "prompt_tokens"),
                    CountOr0(usage, "completion_tokens"),
                    CountOr0(MemberOf(usage, "completion_tokens_details"),
                             "reasoning_tokens")};
    const json& choice = reply.at("choices").at(0);
    const json& message = choice.at("message");
    result.text =
        WithoutThinking(ContentText(MemberOf(message, "content"), {"text"}));
    const std::string refusal = TextOr(message, "refusal");
    const std::string finish = TextOr(choice, "finish_reason");
    if (finish == "length") {
      result.status = ReplyStatus::kTruncated;
      result.error = finish;
    } else if (finish == "content_filter" ||
               (result.text.empty() && !refusal.empty())) {
      result.status = ReplyStatus::kRefused;
      result.error = refusal.empty() ? finish : refusal;
    } else {
      result.status = ReplyStatus::kAnswered;
    }
    return result;
  }

  json JoinEvents(const std::vector<json>& events) const override {
    json reply = json::object();
    std::string text;
    std::string refusal;
    json finish;
    for (const json& event : events) {
      TakeOver(reply, event);
      const json& choices = MemberOf(event, "choices");
      if (!choices.is_array() || choices.empty()) continue;
      const json& delta = MemberOf(choices.front(), "delta");
      text += TextOr(delta, "content");
      refusal += TextOr(delta, "refusal");
      const json& reason = MemberOf(choices.front(), "finish_reason");
      if (!reason.is_null()) finish = reason;
    }
    if (finish.is_null()) return nullptr;
    json message = {{"role", "assistant"}, {"content", text}};
    if (!refusal.empty()) message["refusal"] = refusal;
    reply["choices"] = {{{"message", message}, {"finish_reason", finish}}};
    return reply;
  }

  void ReadErrorJson(const json& error, WireError& result) const override {
    result.final = TextOr(error, "code") == "insufficient_quota";
  }
};

}  // namespace

std::unique_ptr<WireFormat> MakeChatFormat() {
  return std::make_unique<ChatFormat>();
}

}  // namespace terra::advisor
