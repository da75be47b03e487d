// Gemini: POST /v1beta/models/MODEL:generateContent.
#include <algorithm>
#include <cctype>
#include <charconv>

#include "advisor/wire_format.h"
#include "advisor/wire_json.h"
#include "base/base64.h"

namespace terra::advisor {
namespace {

using nlohmann::json;

std::string Upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  });
  return text;
}

class GeminiFormat : public WireFormat {
 public:
  std::string_view provider() const override { return "gemini"; }
  std::string_view default_base_url() const override {
    return "https://generativelanguage.googleapis.com";
  }
  std::string_view default_model() const override {
    return "gemini-3.1-pro-preview";
  }
  std::string_view key_variable() const override { return "GEMINI_API_KEY"; }

  std::string Path(const GenerationSettings& settings) const override {
    // Models may be named as the provider lists them: "models/NAME".
    constexpr std::string_view kPrefix = "models/";
    std::string_view model = settings.model;
    if (model.starts_with(kPrefix)) model.remove_prefix(kPrefix.size());
    return "/v1beta/models/" + std::string(model) + ":generateContent";
  }

  HeaderList Headers(const GenerationSettings&,
                     const std::string& key) const override {
    return {{"x-goog-api-key", key}};
  }

  json Body(const LlmRequest& request,
            const GenerationSettings& settings) const override {
    json parts = json::array();
    for (const auto& picture : request.pictures) {
      parts.push_back({{"inlineData",
                        {{"mimeType", "image/png"},
                         {"data", Base64Encode(picture->png)}}}});
    }
    parts.push_back({{"text", request.text}});
    json generation = {{"maxOutputTokens", settings.max_output_tokens}};
    if (!settings.effort.empty()) {
      generation["thinkingConfig"] = {
          {"thinkingLevel", Upper(settings.effort)}};
    }
    return {{"contents", {{{"role", "user"}, {"parts", parts}}}},
            {"generationConfig", generation}};
  }

 protected:
  WireReply ReadReplyJson(const json& reply) const override {
    WireReply result;
    result.model = TextOr(reply, "modelVersion");
    result.response_id = TextOr(reply, "responseId");
    const json& usage = MemberOf(reply, "usageMetadata");
    const std::int64_t thinking = CountOr0(usage, "thoughtsTokenCount");
    result.usage = {CountOr0(usage, "promptTokenCount"),
                    CountOr0(usage, "candidatesTokenCount") + thinking,
                    thinking};
    const json& candidates = MemberOf(reply, "candidates");
    if (!candidates.is_array() || candidates.empty()) {
      const std::string blocked =
          TextOr(MemberOf(reply, "promptFeedback"), "blockReason");
      if (!blocked.empty()) result.status = ReplyStatus::kRefused;
      result.error = blocked.empty() ? "neither a candidate nor a reason"
                                     : "the prompt was blocked: " + blocked;
      return result;
    }
    const json& candidate = candidates.front();
    result.text = AnswerText(candidate);
    result.has_thinking = thinking > 0 || HasThought(candidate);
    const std::string finish = Upper(TextOr(candidate, "finishReason", "STOP"));
    if (finish == "STOP") {
      result.status = ReplyStatus::kAnswered;
    } else {
      // CONTINUATION is the limit of one request; there is one per case.
      result.status = finish == "MAX_TOKENS" || finish == "CONTINUATION"
                          ? ReplyStatus::kTruncated
                          : ReplyStatus::kRefused;
      result.error = finish;
    }
    return result;
  }

  json JoinEvents(const std::vector<json>& events) const override {
    json reply = json::object();
    json candidate = json::object();
    std::string text;
    for (const json& event : events) {
      TakeOver(reply, event);
      const json& candidates = MemberOf(event, "candidates");
      if (!candidates.is_array() || candidates.empty()) continue;
      TakeOver(candidate, candidates.front());
      text += AnswerText(candidates.front());
    }
    if (candidate.contains("finishReason")) {
      candidate["content"] = {{"parts", json::array({{{"text", text}}})}};
      reply["candidates"] = json::array({candidate});
      return reply;
    }
    const bool blocked = candidate.empty() && reply.contains("promptFeedback");
    return blocked ? reply : json();
  }

  void ReadErrorJson(const json& error, WireError& result) const override {
    for (const json& detail : MemberOf(error, "details")) {
      const std::string type = TextOr(detail, "@type");
      if (type.ends_with("RetryInfo")) {
        result.retry_after_s = Seconds(TextOr(detail, "retryDelay"));
      }
      for (const json& violation : MemberOf(detail, "violations")) {
        // A quota per day does not come back within any deadline of ours.
        result.final =
            result.final ||
            TextOr(violation, "quotaId").find("PerDay") != std::string::npos;
      }
    }
  }

 private:
  /// What the model says in the parts; what it thought is not the answer.
  static std::string AnswerText(const json& candidate) {
    std::string text;
    for (const json& part : MemberOf(MemberOf(candidate, "content"), "parts")) {
      if (MemberOf(part, "thought") != true) text += TextOr(part, "text");
    }
    return text;
  }

  static bool HasThought(const json& candidate) {
    const json& parts = MemberOf(MemberOf(candidate, "content"), "parts");
    return std::any_of(parts.begin(), parts.end(), [](const json& part) {
      return MemberOf(part, "thought") == true;
    });
  }

  /// "22s", "1.5s".
  static std::optional<double> Seconds(const std::string& text) {
    double seconds = 0;
    const char* end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, seconds);
    if (read.ec != std::errc() || end - read.ptr != 1 || *read.ptr != 's') {
      return std::nullopt;
    }
    return seconds;
  }
};

}  // namespace

std::unique_ptr<WireFormat> MakeGeminiFormat() {
  return std::make_unique<GeminiFormat>();
}

}  // namespace terra::advisor
