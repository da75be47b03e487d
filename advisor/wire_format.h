#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "advisor/llm_client.h"

namespace terra::advisor {

/// How a model is asked. The defaults are the paper's; sampling settings are
/// never sent.
struct GenerationSettings {
  std::string model;                      ///< Empty = the provider's default.
  int max_output_tokens = 8'000;          ///< Thinking included.
  std::string effort = "low";             ///< Thinking; empty = not sent.
  std::string image_detail = "original";  ///< openai only.
  std::string anthropic_version = "2026-10-21";
  bool anthropic_bearer = false;  ///< Send the key as bearer token.
};

/// A reply with a success status, as far as the provider's form tells.
struct WireReply {
  ReplyStatus status = ReplyStatus::kNoAnswer;
  std::string text;  ///< Without what the model thought.
  /// Why it is refused, failed or unreadable, or why an answer is empty.
  std::string error;
  bool wrong_form = false;  ///< The body is not in this form.
  /// A failure that the provider reports inside a success may pass on its own,
  /// ...
  bool transient = false;
  std::optional<double> retry_after_s;  ///< ... as far as the body says when.
  bool has_thinking = false;            ///< Beside the text or in it.
  std::string model;
  std::string response_id;
  LlmUsage usage;

  bool came() const { return status != ReplyStatus::kNoAnswer; }
};

/// A reply with an error status.
struct WireError {
  std::string message;
  bool final = false;  ///< Quota or spend limit: asking again cannot help.
  std::optional<double> retry_after_s;  ///< As far as the body says it.
};

using HeaderList = std::vector<std::pair<std::string, std::string>>;

/// What distinguishes the providers on the wire. Pure: texts in, texts out.
/// Facts: the providers' SDKs; golden requests and replies in the tests.
class WireFormat {
 public:
  virtual ~WireFormat() = default;

  virtual std::string_view provider() const = 0;
  virtual std::string_view default_base_url() const = 0;
  virtual std::string_view default_model() const = 0;
  /// The environment variable that holds the key.
  virtual std::string_view key_variable() const = 0;
  /// May there be no key? (A local server.)
  virtual bool key_optional() const { return false; }

  virtual std::string Path(const GenerationSettings& settings) const = 0;
  virtual nlohmann::json Body(const LlmRequest& request,
                              const GenerationSettings& settings) const = 0;
  virtual HeaderList Headers(const GenerationSettings& settings,
                             const std::string& key) const = 0;

  /// A server may stream what nobody asked it to stream. Returns the reply as
  /// it would have come at once: an event stream joined, any other body as it
  /// is; nothing where a stream ends before its answer. Reads any bytes.
  std::optional<std::string> Whole(std::string body) const;

  /// Reads any bytes; kNoAnswer with an error where they are not in this form.
  WireReply ReadReply(std::string_view body) const;

  /// Reads any bytes; without a message where they are not in this form.
  WireError ReadError(std::string_view body) const;

 protected:
  /// No answer, but a failure that the server reports inside a success; what
  /// it says `otherwise` counts where the error itself has no message.
  WireReply FailureOf(const nlohmann::json& error,
                      const std::string& otherwise = "") const;

  /// May throw nlohmann::json::exception for a wrong form. Thinking inside the
  /// text is taken out afterwards.
  virtual WireReply ReadReplyJson(const nlohmann::json& reply) const = 0;
  /// The reply whose events these are; null without the answer's end.
  virtual nlohmann::json JoinEvents(
      const std::vector<nlohmann::json>& events) const = 0;
  /// Adds what is the provider's own; `error` is the object of that name.
  virtual void ReadErrorJson(const nlohmann::json& error,
                             WireError& result) const = 0;

 private:
  WireError ReadErrorValue(const nlohmann::json& error) const;
};

/// The settings that change answers, as JSON text with sorted keys.
std::string SettingsText(const WireFormat& format,
                         const GenerationSettings& settings);

std::unique_ptr<WireFormat> MakeOpenAiFormat();
std::unique_ptr<WireFormat> MakeGeminiFormat();
std::unique_ptr<WireFormat> MakeAnthropicFormat();
std::unique_ptr<WireFormat> MakeChatFormat();

/// "openai", "gemini", "anthropic", "chat"; null for any other name.
std::unique_ptr<WireFormat> MakeWireFormat(std::string_view provider);

}  // namespace terra::advisor
