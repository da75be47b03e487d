#include "advisor/recording_clients.h"

#include <filesystem>
#include <optional>
#include <utility>

#include "advisor/recording.h"
#include "base/utc.h"

namespace terra::advisor {

Result<std::unique_ptr<LlmClient>> RecordingClient::Create(
    std::unique_ptr<LlmClient> inner, const std::string& path, bool images) {
  std::string image_folder;
  std::error_code failed;
  if (images) {
    image_folder = path + ".images";
    std::filesystem::create_directories(image_folder, failed);
  }
  if (failed) {
    return Error{ErrorCode::kUnavailable,
                 image_folder + ": " + failed.message()};
  }
  auto file = OpenRecording(path);
  if (!file) return file.error();
  return std::unique_ptr<LlmClient>(std::make_unique<RecordingClient>(
      std::move(inner), *std::move(file), std::move(image_folder)));
}

RecordingClient::RecordingClient(std::unique_ptr<LlmClient> inner,
                                 std::ofstream file, std::string image_folder)
    : inner_(std::move(inner)),
      file_(std::move(file)),
      image_folder_(std::move(image_folder)) {}

LlmReply RecordingClient::Ask(const LlmRequest& request, std::stop_token stop) {
  LlmReply reply = inner_->Ask(request, stop);
  if (reply.came()) {
    const Status kept = image_folder_.empty()
                            ? Status(Done{})
                            : KeepImages(request, image_folder_);
    file_ << FormatRecord(identity(), request, reply, UtcNow()) << std::flush;
    if (!kept || !file_) {
      // The answer is still good; that it was not kept must not stay unseen.
      reply.error += reply.error.empty() ? "" : "; ";
      reply.error += kept.ok() ? "the recording could not be written"
                               : kept.error().message;
      file_.clear();
    }
  }
  return reply;
}

namespace {

Result<RecordedReplies> ReadReplies(const std::string& path,
                                    const std::string& model) {
  RecordedReplies recorded;
  bool any = false;
  const Status read =
      ForEachRecordedCall(path, [&](RecordedCall call, const std::string& at) {
        if (!model.empty() && call.identity.model != model) {
          return Status(Done{});
        }
        if (!any) {
          recorded.identity = call.identity;
        }
        any = true;
        if (recorded.identity.model != call.identity.model ||
            recorded.identity.settings != call.identity.settings) {
          return Status(Error{
              ErrorCode::kInvalid,
              at + "another model or other settings than before; choose one "
                   "with --model, or split the file"});
        }
        recorded.replies[RecordKey(call.request_hash, call.repeat)] =
            std::move(call.reply);
        return Status(Done{});
      });
  if (!read) {
    return read.error();
  }
  if (!any) {
    return Error{
        ErrorCode::kNotFound,
        path + ": no recorded call" + (model.empty() ? "" : " of ") + model};
  }
  return recorded;
}

bool SameModel(const LlmIdentity& a, const LlmIdentity& b) {
  return a.model == b.model && a.settings == b.settings;
}

}  // namespace

Result<std::unique_ptr<LlmClient>> ReplayClient::Create(
    const std::string& path, const std::string& model, ReplayFile file) {
  if (path.empty()) {
    return Error{ErrorCode::kInvalid,
                 "replay needs a recording: --recording F.jsonl"};
  }
  auto client = std::make_unique<ReplayClient>(path, model, file);
  const Status read = client->watch_.Begin();
  if (!read) return read.error();
  return std::unique_ptr<LlmClient>(std::move(client));
}

ReplayClient::ReplayClient(const std::string& path, const std::string& model,
                           ReplayFile file)
    : file_(file), watch_([this, path, model] {
        return Read(path, model);
      }) {}

Status ReplayClient::Read(const std::string& path, const std::string& model) {
  OpenedFiles::Note(path);
  Result<RecordedReplies> recorded = ReadReplies(path, model);
  if (!recorded) return recorded.error();
  if (!recorded_.replies.empty() &&
      !SameModel(recorded_.identity, recorded->identity)) {
    return Error{ErrorCode::kInvalid,
                 path +
                     ": it is of another model or other settings now; "
                     "restart to answer from it"};
  }
  recorded_ = *std::move(recorded);
  return Done{};
}

LlmReply ReplayClient::Ask(const LlmRequest& request, std::stop_token) {
  if (file_ == ReplayFile::kWatched) {
    const std::optional<Status> read = watch_.ReadIfChanged();
    if (read) {
      not_read_ = read->ok() ? "" : read->error().message;
    }
  }
  LlmReply reply = Recorded(request);
  if (!not_read_.empty()) {
    reply.error += (reply.error.empty() ? "" : "; ") +
                   ("the recording was not read again: " + not_read_);
  }
  return reply;
}

LlmReply ReplayClient::Recorded(const LlmRequest& request) const {
  const std::string hash = RequestHash(recorded_.identity, request);
  const auto at = recorded_.replies.find(RecordKey(hash, request.repeat));
  if (at != recorded_.replies.end()) {
    return at->second;
  }
  LlmReply none;
  none.reason = NoAnswer::kNotRecorded;
  none.error =
      "the recording has no answer to this question; another map, "
      "method, model or setting? Request " +
      hash + ", repeat " + std::to_string(request.repeat);
  return none;
}

}  // namespace terra::advisor
