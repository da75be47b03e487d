#pragma once

#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "advisor/llm_client.h"
#include "terrain/result.h"

namespace terra::advisor {

/// One call as a recording keeps it: JSON lines, version 1.
///
/// Fields: schema, request_hash, repeat, case_id, method, prompt_id, provider,
/// endpoint_class, model_requested, model_returned, response_id, utc, settings,
/// prompt_text, images (SHA-256 of each PNG), status, answer_text, error,
/// reply_body, tokens_in, tokens_out, tokens_thinking, spend_usd (or null),
/// tries, t_llm_s (null for files and batches). Never a key, nor a header that
/// carries one.
struct RecordedCall {
  std::string request_hash;
  int repeat = 0;
  LlmIdentity identity;
  LlmReply reply;  ///< reply.recorded_at is the time of the call.
};

/// Writes a line, with its line end.
std::string FormatRecord(const LlmIdentity& identity, const LlmRequest& request,
                         const LlmReply& reply, const std::string& utc);

/// Puts a reply into the line of a call that has none yet: FormatRecord of an
/// empty reply, as a batch keeps its open requests. Errors: no such line.
Result<std::string> AnswerRecord(std::string_view open_line,
                                 const LlmReply& reply, const std::string& utc);

/// Reads a line. Errors say what is missing.
Result<RecordedCall> ParseRecord(std::string_view line);

/// The time of a call as recordings write it.
std::string UtcNow();

/// What a recording files a call under: hash and repeat.
std::string RecordKey(const std::string& request_hash, int repeat);

/// The keys of all calls that a recording holds; none without the file. A
/// damaged last line (a run that was killed) is left out. Errors: name the
/// line.
Result<std::unordered_set<std::string>> ReadRecordKeys(const std::string& path);

/// Opens a recording to be added to. What a writer that was killed left of a
/// last line is cut off. Errors: cannot be written.
Result<std::ofstream> OpenRecording(const std::string& path);

/// Writes the pictures of a request into a folder, under their hash.
void KeepImages(const LlmRequest& request, const std::string& folder);

/// Asks another client and keeps what came. Calls without an answer are not
/// kept, so a later run asks again.
class RecordingClient : public LlmClient {
 public:
  /// Appends to `path`; with `images` the PNGs go beside it, into a folder
  /// PATH.images, under their hash. Errors: cannot be written.
  static Result<std::unique_ptr<LlmClient>> Create(
      std::unique_ptr<LlmClient> inner, const std::string& path, bool images);

  RecordingClient(std::unique_ptr<LlmClient> inner, std::ofstream file,
                  std::string image_folder);

  const LlmIdentity& identity() const override { return inner_->identity(); }
  LlmReply Ask(const LlmRequest& request, std::stop_token stop) override;

 private:
  std::unique_ptr<LlmClient> inner_;
  std::ofstream file_;
  std::string image_folder_;  ///< Empty = images are not kept.
};

/// Answers from a recording, bit for bit, without any network.
class ReplayClient : public LlmClient {
 public:
  /// Reads the recording; with a model given, only its calls. A damaged last
  /// line (a run that was killed) is left out. Errors: name file and line; more
  /// than one model or settings, and none chosen.
  static Result<std::unique_ptr<LlmClient>> Create(const std::string& path,
                                                   const std::string& model);

  ReplayClient(LlmIdentity identity,
               std::unordered_map<std::string, LlmReply> replies);

  const LlmIdentity& identity() const override { return identity_; }
  /// The last recorded reply to this very question and repeat; kNotRecorded
  /// where there is none.
  LlmReply Ask(const LlmRequest& request, std::stop_token stop) override;

 private:
  LlmIdentity identity_;
  std::unordered_map<std::string, LlmReply> replies_;  ///< By hash and repeat.
};

}  // namespace terra::advisor
