#include "advisor/exchange_client.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

#include "advisor/interruptible_wait.h"
#include "output/output_file.h"

namespace terra::advisor {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::uintmax_t kMaxAnswerBytes = 1u << 20;

constexpr const char* kReadme =
    "Each folder here is a question to a language model, for a person or a\n"
    "program to answer: image-1.png and so on, and prompt.txt, which comes\n"
    "last. Write the answer, in the form that the prompt's end asks for, to\n"
    "answer.txt in the same folder; programs write it under another name and\n"
    "rename it. A question that has its answer is not asked again: remove\n"
    "answer.txt to change one.\n";

// Each file whole or not at all, so that nobody reads half a question.
Status WriteQuestion(const fs::path& folder, const LlmRequest& request) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) {
    return Error{ErrorCode::kUnavailable,
                 folder.string() + ": " + failed.message()};
  }
  const fs::path readme = folder.parent_path() / "README.txt";
  if (!fs::exists(readme, failed)) {
    const Status written = WriteWholeFile(readme.string(), kReadme);
    if (!written.ok()) return written;
  }
  int number = 0;
  for (const auto& picture : request.pictures) {
    const std::string name = "image-" + std::to_string(++number) + ".png";
    const Status written =
        WriteWholeFile((folder / name).string(), picture->png);
    if (!written.ok()) return written;
  }
  // Last, so that who sees it finds the pictures too.
  return WriteWholeFile((folder / "prompt.txt").string(), request.text);
}

/// Size of the answer file; none while it is missing or empty.
std::optional<std::uintmax_t> AnswerSize(const fs::path& path) {
  std::error_code failed;
  const std::uintmax_t size = fs::file_size(path, failed);
  return failed || size == 0 ? std::nullopt : std::optional(size);
}

}  // namespace

std::string ExchangeName(const LlmIdentity& identity,
                         const LlmRequest& request) {
  constexpr std::size_t kMaxName = 64;
  std::string name = request.case_id.substr(0, kMaxName);
  std::replace_if(
      name.begin(), name.end(),
      [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' &&
               c != '-';
      },
      '_');
  // No option of a command line: map ids may be negative.
  if (name.starts_with('-')) name.front() = '_';
  name += "-" + RequestHash(identity, request).substr(0, 12);
  return request.repeat == 0 ? name
                             : name + "-" + std::to_string(request.repeat);
}

ExchangeClient::ExchangeClient(ExchangeOptions options)
    : options_(std::move(options)),
      identity_{"exchange", options_.model, "{}", "file"} {}

LlmReply ExchangeClient::Ask(const LlmRequest& request, std::stop_token stop) {
  LlmReply reply;
  const auto begin = Clock::now();
  const auto seconds = [begin] {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  const fs::path folder =
      fs::path(options_.folder) / ExchangeName(identity_, request);
  const fs::path answer = folder / "answer.txt";
  if (!AnswerSize(answer)) {
    const Status asked = WriteQuestion(folder, request);
    if (!asked.ok()) {
      reply.reason = NoAnswer::kTransport;
      reply.error = "the question cannot be asked: " + asked.error().message;
      return reply;
    }
  }
  reply.tries = 1;
  std::optional<std::uintmax_t> before;
  for (;;) {
    const auto size = AnswerSize(answer);
    if (size && size == before) break;
    before = size;
    if (seconds() >= options_.deadline_s) {
      reply.reason = NoAnswer::kDeadline;
      reply.error = answer.string() + ": no answer in time";
      return reply;
    }
    if (!WaitUnlessStopped(options_.poll_s, stop)) {
      reply.reason = NoAnswer::kCancelled;
      return reply;
    }
  }
  reply.t_llm_s = seconds();
  reply.timed = false;
  if (*before > kMaxAnswerBytes) {
    reply.reason = NoAnswer::kTooLarge;
    return reply;
  }
  std::ifstream file(answer, std::ios::binary);
  reply.text.assign(std::istreambuf_iterator<char>(file), {});
  reply.status = ReplyStatus::kAnswered;
  reply.model = options_.model;
  return reply;
}

}  // namespace terra::advisor
