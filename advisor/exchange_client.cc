#include "advisor/exchange_client.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <utility>

#include "advisor/answer_parser.h"
#include "advisor/interruptible_wait.h"
#include "advisor/thinking.h"
#include "output/output_file.h"
#include "terrain/utf8.h"

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

/// Size of the answer file; none while it is missing.
std::optional<std::uintmax_t> AnswerSize(const fs::path& path) {
  std::error_code failed;
  const std::uintmax_t size = fs::file_size(path, failed);
  return failed ? std::nullopt : std::optional(size);
}

/// A folder, a pipe or a device under the answer's name: it never becomes an
/// answer by itself, and reading it might wait without end.
bool IsNoFile(const fs::path& path) {
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  return fs::exists(status) && !fs::is_regular_file(status);
}

/// What an answer file holds at a look.
struct Look {
  bool answered = false;
  bool too_large = false;
  std::string text;
  std::string problem;  ///< Why there is no answer in it yet; for people.
};

Look LookInto(const fs::path& path, std::uintmax_t size) {
  Look look;
  look.too_large = size > kMaxAnswerBytes;
  if (look.too_large) return look;
  std::ifstream file(path, std::ios::binary);
  look.text.assign(std::istreambuf_iterator<char>(file), {});
  if (!file) {
    look.problem = "cannot be read";
  } else if (IsBlankAnswer(look.text)) {
    look.problem = "is empty";
  } else {
    look.answered = true;
  }
  return look;
}

/// Says what to do about an answer in another encoding; empty where it is
/// UTF-8.
std::string EncodingHint(std::string_view text) {
  const bool marked =
      text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
  if (marked || text.find('\0') != std::string_view::npos) {
    return "answer.txt looks like UTF-16 or holds zero bytes: save it as UTF-8";
  }
  return IsUtf8(text) ? ""
                      : "answer.txt is no UTF-8 (perhaps Latin-1): save it as "
                        "UTF-8";
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
  if (AnswerSize(answer).value_or(0) == 0) {
    const Status asked = WriteQuestion(folder, request);
    if (!asked.ok()) {
      reply.reason = NoAnswer::kTransport;
      reply.error = "the question cannot be written: " + asked.error().message;
      return reply;
    }
  }
  reply.tries = 1;
  std::optional<std::uintmax_t> before;
  std::string said;
  Look look;
  // The worker's thread: nobody waits for it but the question.
  const auto say_once = [&](const std::string& problem) {
    if (problem == said) return;
    std::cerr << answer.string() + ": " + problem +
                     "; waiting until an answer is in it\n";
    said = problem;
  };
  for (;;) {
    const auto size = AnswerSize(answer);
    if (size && size == before) {
      look = LookInto(answer, *size);
      if (look.answered || look.too_large) break;
      say_once(look.problem);
    } else if (!size && IsNoFile(answer)) {
      say_once("is no regular file: replace it by one");
    }
    before = size;
    if (seconds() >= options_.deadline_s) {
      reply.reason = NoAnswer::kDeadline;
      reply.error = answer.string() + ": no answer in time" +
                    (said.empty() ? "" : ", it " + said);
      return reply;
    }
    if (!WaitUnlessStopped(options_.poll_s, stop)) {
      reply.reason = NoAnswer::kCancelled;
      return reply;
    }
  }
  reply.t_llm_s = seconds();
  reply.timed = false;
  if (look.too_large) {
    reply.reason = NoAnswer::kTooLarge;
    reply.error = answer.string() + ": more than " +
                  std::to_string(kMaxAnswerBytes) + " bytes";
    return reply;
  }
  reply.status = ReplyStatus::kAnswered;
  reply.error = EncodingHint(look.text);
  reply.text = WithoutThinking(look.text);
  reply.model = options_.model;
  return reply;
}

}  // namespace terra::advisor
