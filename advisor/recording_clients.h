#pragma once

#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <unordered_map>

#include "advisor/llm_client.h"
#include "terrain/files/file_watch.h"
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

/// What a recording holds of one model.
struct RecordedReplies {
  LlmIdentity identity;
  std::unordered_map<std::string, LlmReply> replies;  ///< By hash and repeat.
};

/// Whether a recording that changes is read again.
enum class ReplayFile : std::uint8_t {
  kOnce,     ///< An evaluation: the same answers from beginning to end.
  kWatched,  ///< A robot: what is in the file now.
};

/// Answers from a recording, bit for bit, without any network.
class ReplayClient : public LlmClient {
 public:
  /// Reads the recording; with a model given, only its calls. A damaged last
  /// line (a run that was killed) is left out. Errors: name file and line; more
  /// than one model or settings, and none chosen.
  static Result<std::unique_ptr<LlmClient>> Create(const std::string& path,
                                                   const std::string& model,
                                                   ReplayFile file);

  ReplayClient(const std::string& path, const std::string& model,
               ReplayFile file);

  const LlmIdentity& identity() const override { return recorded_.identity; }
  /// The last recorded reply to this very question and repeat; kNotRecorded
  /// where there is none. A watched recording that cannot be read any more, or
  /// is of another model now, leaves the answers as they were, and the reply's
  /// error says so.
  LlmReply Ask(const LlmRequest& request, std::stop_token stop) override;

 private:
  Status Read(const std::string& path, const std::string& model);
  LlmReply Recorded(const LlmRequest& request) const;

  RecordedReplies recorded_;
  ReplayFile file_;
  FileWatch watch_;
  std::string not_read_;  ///< Why the newest state of the file was not read.
};

}  // namespace terra::advisor
