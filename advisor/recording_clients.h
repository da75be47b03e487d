#pragma once

#include <fstream>
#include <memory>
#include <string>
#include <unordered_map>

#include "advisor/llm_client.h"
#include "terrain/result.h"

namespace terra::advisor {

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
