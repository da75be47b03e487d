#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "advisor/encoded_picture.h"

namespace terra::advisor {

/// One question to a model: what it is shown, and what it is filed under.
struct LlmRequest {
  std::string text;
  /// In the order in which the text numbers them.
  std::vector<std::shared_ptr<const EncodedPicture>> pictures;

  std::string method;     ///< "advisor", "direct", "llm-astar".
  std::string prompt_id;  ///< PromptId(): which wording the text follows.
  std::string case_id;    ///< For recordings and folders; not in the hash.
  int repeat = 0;         ///< Same question asked again, from 0.
};

/// Who answers and how it was asked to; part of the request hash.
struct LlmIdentity {
  std::string provider;  ///< "openai", ..., "exchange".
  std::string model;     ///< As requested.
  /// Settings that change answers, as JSON text with sorted keys.
  std::string settings = "{}";
  /// Where the request goes: "provider", "loopback" (results are SIMULATED),
  /// "loopback-model" (a real model on this machine), "other ADDRESS" (a
  /// server of the user's), "file".
  std::string endpoint_class;
};

enum class ReplyStatus {
  kNoAnswer,   ///< Nothing came: no attempt.
  kAnswered,   ///< The text is the whole answer; it may be empty or nonsense.
  kTruncated,  ///< Cut by the token limit: an attempt, invalid.
  kRefused,    ///< Refused or blocked by the provider: an attempt, invalid.
};

/// Why nothing came.
enum class NoAnswer {
  kNone,
  kTransport,    ///< No connection, reset, cut body, time-out of one try.
  kHttpStatus,   ///< The provider answered with an error.
  kBadReply,     ///< A success whose body is not the provider's form.
  kTooLarge,     ///< More bytes than allowed.
  kDeadline,     ///< The case's total deadline passed.
  kCancelled,    ///< The caller asked to stop.
  kRateLimit,    ///< Own limit of calls per minute.
  kSpendLimit,   ///< Own limit of spend per hour.
  kBreakerOpen,  ///< Too many failures in succession; waiting.
  kNotRecorded,  ///< Replay: the recording has no such request.
};

/// Returns "transport", "http_status", ... as printed and documented.
std::string_view NoAnswerName(NoAnswer reason);

struct LlmUsage {
  std::int64_t tokens_in = 0;        ///< Cached ones included.
  std::int64_t tokens_out = 0;       ///< Thinking included.
  std::int64_t tokens_thinking = 0;  ///< Where the provider tells.
};

/// What came back.
struct LlmReply {
  ReplyStatus status = ReplyStatus::kNoAnswer;
  NoAnswer reason = NoAnswer::kNone;  ///< Set when status is kNoAnswer.
  std::string text;                   ///< The answer, thinking left out.
  std::string error;                  ///< One line for people; never a key.
  int http_status = 0;                ///< Of the last try; 0 = none came.

  std::string model;        ///< As the reply named it; empty when it did not.
  std::string response_id;  ///< The provider's.
  LlmUsage usage;
  std::optional<double> spend_usd;  ///< Unknown without a price.
  std::string body;  ///< The reply as it came (a stream: joined), to be kept.

  int tries = 0;       ///< Requests sent.
  double t_llm_s = 0;  ///< First byte sent to last received, waits included.
  /// False where that says nothing of a model: files, batches.
  bool timed = true;
  std::string recorded_at;  ///< UTC of the original call, when replayed.

  bool came() const { return status != ReplyStatus::kNoAnswer; }
};

/// Something that answers: a provider, a recording, a person.
///
/// Threads: one call at a time per object, on any thread; the stop token may be
/// triggered from any other.
class LlmClient {
 public:
  virtual ~LlmClient() = default;

  virtual const LlmIdentity& identity() const = 0;

  /// Asks once (with the client's own retries) and waits. Returns promptly with
  /// kCancelled when asked to stop. Never throws for what the outside does.
  virtual LlmReply Ask(const LlmRequest& request, std::stop_token stop) = 0;
};

/// The key of recordings: XXH3-128 in hexadecimal over method, model, settings,
/// text and the pictures' decoded pixels. Neither the provider nor the PNG
/// encoder counts, so it is the same on every machine.
std::string RequestHash(const LlmIdentity& identity, const LlmRequest& request);

}  // namespace terra::advisor
