// OpenAI-compatible chat: POST /v1/chat/completions (llama.cpp, Ollama, vLLM).
#include "advisor/wire_format.h"
#include "advisor/wire_json.h"

namespace terra::advisor {
namespace {

using nlohmann::json;

/// Where servers put what a model thinks.
bool HasThinking(const json& message) {
  return !TextOr(message, "reasoning_content").empty() ||
         !TextOr(message, "reasoning").empty() ||
         !TextOr(message, "thinking").empty();
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
    const json& choices = reply.at("choices");
    if (choices.is_array() && choices.empty()) {
      result.error = "no choice in the reply";
      return result;
    }
    const json& choice = choices.at(0);
    const json& message = MemberOf(choice, "message");
    if (!message.is_object()) {
      result.wrong_form = true;
      result.error = "no message in the reply's choice";
      return result;
    }
    result.text = ContentText(MemberOf(message, "content"), {"text"});
    result.has_thinking = HasThinking(message);
    const std::string refusal = TextOr(message, "refusal");
    const std::string finish = TextOr(choice, "finish_reason");
    if (finish == "error") {
      // Of gateways: what they stand before failed amid its answer.
      result.error = "the server's model failed (finish_reason error)";
      result.transient = true;
    } else if (finish == "length") {
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
    std::string thought;
    std::string refusal;
    json finish;
    json failure;
    for (const json& event : events) {
      TakeOver(reply, event);
      const json& choices = MemberOf(event, "choices");
      if (!choices.is_array() || choices.empty()) continue;
      const json& delta = MemberOf(choices.front(), "delta");
      text += TextOr(delta, "content");
      refusal += TextOr(delta, "refusal");
      const json& reason = MemberOf(choices.front(), "finish_reason");
      if (!reason.is_null()) finish = reason;
      const json& error = MemberOf(choices.front(), "error");
      if (!error.is_null()) failure = error;
      thought +=
          TextOr(delta, "reasoning_content") + TextOr(delta, "reasoning");
    }
    if (finish.is_null() && failure.is_null()) return nullptr;
    json message = {{"role", "assistant"}, {"content", text}};
    if (!refusal.empty()) message["refusal"] = refusal;
    if (!thought.empty()) message["reasoning_content"] = thought;
    reply["choices"] = {
        {{"message", message}, {"finish_reason", finish}, {"error", failure}}};
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
