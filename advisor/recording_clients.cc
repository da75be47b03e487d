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
    if (!kept.ok() || !file_) {
      // The answer is still good; that it was not kept must not stay unseen.
      reply.error += reply.error.empty() ? "" : "; ";
      reply.error += kept.ok() ? "the recording could not be written"
                               : kept.error().message;
      file_.clear();
    }
  }
  return reply;
}

Result<std::unique_ptr<LlmClient>> ReplayClient::Create(
    const std::string& path, const std::string& model) {
  if (path.empty()) {
    return Error{ErrorCode::kInvalid,
                 "replay needs a recording: --recording F.jsonl"};
  }
  std::optional<LlmIdentity> identity;
  std::unordered_map<std::string, LlmReply> replies;
  const Status read =
      ForEachRecordedCall(path, [&](RecordedCall call, const std::string& at) {
        if (!model.empty() && call.identity.model != model) {
          return Status(Done{});
        }
        if (!identity) identity = call.identity;
        if (identity->model != call.identity.model ||
            identity->settings != call.identity.settings) {
          return Status(Error{
              ErrorCode::kInvalid,
              at + "another model or other settings than before; choose one "
                   "with --model, or split the file"});
        }
        replies[RecordKey(call.request_hash, call.repeat)] =
            std::move(call.reply);
        return Status(Done{});
      });
  if (!read) return read.error();
  if (!identity) {
    return Error{
        ErrorCode::kNotFound,
        path + ": no recorded call" + (model.empty() ? "" : " of ") + model};
  }
  return std::unique_ptr<LlmClient>(
      std::make_unique<ReplayClient>(*std::move(identity), std::move(replies)));
}

ReplayClient::ReplayClient(LlmIdentity identity,
                           std::unordered_map<std::string, LlmReply> replies)
    : identity_(std::move(identity)), replies_(std::move(replies)) {}

LlmReply ReplayClient::Ask(const LlmRequest& request, std::stop_token) {
  const std::string hash = RequestHash(identity_, request);
  const auto at = replies_.find(RecordKey(hash, request.repeat));
  if (at != replies_.end()) {
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
