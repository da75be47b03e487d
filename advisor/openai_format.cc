// OpenAI Responses: POST /v1/responses.
#include "advisor/wire_format.h"
#include "advisor/wire_json.h"

namespace terra::advisor {
namespace {

using nlohmann::json;

class OpenAiFormat : public WireFormat {
 public:
  std::string_view provider() const override { return "openai"; }
  std::string_view default_base_url() const override {
    return "https://api.openai.com";
  }
  std::string_view default_model() const override { return "gpt-5.5"; }
  std::string_view key_variable() const override { return "OPENAI_API_KEY"; }

  std::string Path(const GenerationSettings&) const override {
    return "/v1/responses";
  }

  HeaderList Headers(const GenerationSettings&,
                     const std::string& key) const override {
    return {{"authorization", "Bearer " + key}};
  }

  json Body(const LlmRequest& request,
            const GenerationSettings& settings) const override {
    json content = json::array();
    for (const auto& picture : request.pictures) {
      json part = {{"type", "input_image"}, {"image_url", DataUri(*picture)}};
      if (!settings.image_detail.empty()) {
        part["detail"] = settings.image_detail;
      }
      content.push_back(std::move(part));
    }
    content.push_back({{"type", "input_text"}, {"text", request.text}});
    json body = {{"model", settings.model},
                 {"input", {{{"role", "user"}, {"content", content}}}},
                 {"max_output_tokens", settings.max_output_tokens}};
    if (!settings.effort.empty()) {
      body["reasoning"] = {{"effort", settings.effort}};
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
        CountOr0(usage, "input_tokens"), CountOr0(usage, "output_tokens"),
        CountOr0(MemberOf(usage, "output_tokens_details"), "reasoning_tokens")};
    const std::string status = TextOr(reply, "status");
    if (status == "failed" || status == "cancelled") {
      WireReply failure = FailureOf(MemberOf(reply, "error"), status);
      failure.model = result.model;
      failure.response_id = result.response_id;
      failure.usage = result.usage;
      return failure;
    }
    // Servers that imitate this form may leave the status out.
    const bool final =
        status == "completed" || status == "incomplete" || status.empty();
    if (!final || !ReadOutput(reply, result, !status.empty())) {
      result.wrong_form = true;
      result.error = "no final status and answer in the reply";
      return result;
    }
    if (status == "incomplete") {
      const std::string reason =
          TextOr(MemberOf(reply, "incomplete_details"), "reason");
      result.status = reason == "content_filter" ? ReplyStatus::kRefused
                                                 : ReplyStatus::kTruncated;
      result.error = reason;
    }
    return result;
  }

  /// Its end repeats the whole response.
  json JoinEvents(const std::vector<json>& events) const override {
    for (const json& event : events) {
      if (TextOr(event, "type") == "error") return {{"error", event}};
      const json& response = MemberOf(event, "response");
      const std::string status = TextOr(response, "status");
      if (response.is_object() && status != "in_progress" &&
          status != "queued") {
        return response;
      }
    }
    return nullptr;
  }

  void ReadErrorJson(const json& error, WireError& result) const override {
    result.final = TextOr(error, "code") == "insufficient_quota" ||
                   TextOr(error, "type") == "insufficient_quota";
  }

 private:
  /// Joins the text parts of all messages; where one is marked as the final
  /// answer, only of those, so that no commentary is glued to a Yes. False
  /// where there is no output, or no message where one is due.
  static bool ReadOutput(const json& reply, WireReply& result,
                         bool may_be_empty) {
    const json& output = MemberOf(reply, "output");
    const json& joined = MemberOf(reply, "output_text");
    if (!output.is_array() && !joined.is_string()) return false;
    bool has_final = false;
    for (const json& item : output) {
      has_final = has_final || TextOr(item, "phase") == "final_answer";
    }
    bool has_message = false;
    std::string refusal;
    for (const json& item : output) {
      if (TextOr(item, "type") == "reasoning") result.has_thinking = true;
      if (TextOr(item, "type") != "message" ||
          (has_final && TextOr(item, "phase") != "final_answer")) {
        continue;
      }
      has_message = true;
      const json& content = item.at("content");
      result.text += ContentText(content, {"output_text", "text"});
      for (const json& part : content) refusal += TextOr(part, "refusal");
    }
    if (!has_message && joined.is_string()) {
      // Not on the provider's wire: the SDKs add it, and some servers too.
      has_message = true;
      result.text = joined.get<std::string>();
    }
    if (!has_message && !may_be_empty) return false;
    result.status = ReplyStatus::kAnswered;
    if (result.text.empty() && !refusal.empty()) {
      result.status = ReplyStatus::kRefused;
      result.error = refusal;
    }
    return true;
  }
};

}  // namespace

std::unique_ptr<WireFormat> MakeOpenAiFormat() {
  return std::make_unique<OpenAiFormat>();
}

}  // namespace terra::advisor
