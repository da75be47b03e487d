// Recordings and the exchange of files, at the level of clients.
#include "advisor/recording.h"

#include <filesystem>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "advisor/exchange_client.h"
#include "advisor/limited_client.h"
#include "advisor/recording_clients.h"
#include "tests/support/captured_errors.h"
#include "tests/support/temp_folder.h"

namespace terra::advisor {
namespace {

namespace fs = std::filesystem;
using testing::CapturedErrors;
using ::testing::HasSubstr;
using testing::ReadBytes;
using testing::TempFolder;

LlmRequest Question(const std::string& text, int repeat = 0) {
  LlmRequest request;
  request.text = text;
  request.method = "advisor";
  request.case_id = "-5 [(1, 2), (3, 4)]";
  request.repeat = repeat;
  auto picture = std::make_shared<EncodedPicture>();
  picture->png = "\x89PNG";
  picture->pixel_hash = "hash";
  request.pictures.push_back(std::move(picture));
  return request;
}

// Says to each question that it was asked it.
class Echo : public LlmClient {
 public:
  const LlmIdentity& identity() const override { return identity_; }
  LlmReply Ask(const LlmRequest& request, std::stop_token) override {
    ++calls;
    LlmReply reply;
    if (fails) {
      reply.reason = NoAnswer::kTransport;
      return reply;
    }
    reply.status = ReplyStatus::kAnswered;
    reply.text = "to " + request.text + " \xff\n";
    reply.body = "{\"bytes\":\"\xfe\"}";
    reply.t_llm_s = 1.5;
    reply.tries = 2;
    return reply;
  }

  bool fails = false;
  int calls = 0;

 private:
  LlmIdentity identity_{"openai", "m", "{}", "loopback"};
};

void Record(const std::string& path, const std::string& text) {
  auto client = RecordingClient::Create(std::make_unique<Echo>(), path, false);
  ASSERT_TRUE(client.ok());
  (*client)->Ask(Question(text), {});
}

TEST(Recording, IsAddedToAndTheLastReplyCounts) {
  const TempFolder folder;
  const std::string path = folder.Path("calls.jsonl");
  Record(path, "a");
  Record(path, "b");
  auto replay = ReplayClient::Create(path, "", ReplayFile::kOnce);
  ASSERT_TRUE(replay.ok());
  EXPECT_THAT((*replay)->Ask(Question("a"), {}).text, HasSubstr("to a "));
  EXPECT_EQ((*replay)->Ask(Question("b"), {}).t_llm_s, 1.5);
  EXPECT_EQ((*replay)->Ask(Question("b", 1), {}).reason,
            NoAnswer::kNotRecorded);
  EXPECT_EQ(ReadRecordKeys(path).value().size(), 2u);
}

TEST(Recording, WhatAKilledWriterLeftIsCutOffBeforeTheNextLine) {
  const TempFolder folder;
  const std::string path = folder.Path("calls.jsonl");
  Record(path, "a");
  const std::string whole = ReadBytes(path);
  for (const std::size_t cut :
       {std::size_t{1}, whole.size() / 2, whole.size() - 1}) {
    std::ofstream(path, std::ios::binary) << whole << whole.substr(0, cut);
    Record(path, "b");
    auto replay = ReplayClient::Create(path, "", ReplayFile::kOnce);
    ASSERT_TRUE(replay.ok()) << cut;
    EXPECT_TRUE((*replay)->Ask(Question("a"), {}).came());
    EXPECT_TRUE((*replay)->Ask(Question("b"), {}).came());
  }
}

TEST(Recording, ADamagedLineInItsMiddleIsNamed) {
  const TempFolder folder;
  const std::string path = folder.Path("calls.jsonl");
  Record(path, "a");
  const std::string whole = ReadBytes(path);
  std::ofstream(path, std::ios::binary) << whole << "{}\n" << whole;
  const auto replay = ReplayClient::Create(path, "", ReplayFile::kOnce);
  ASSERT_FALSE(replay.ok());
  EXPECT_THAT(replay.error().message, HasSubstr("calls.jsonl:2: "));
}

LlmReply AskOnce(LlmClient& client, const std::string& text) {
  return client.Ask(Question(text), {});
}

TEST(Recording, WhatARobotReplaysIsReadAgainWhenItChanges) {
  const TempFolder folder;
  const std::string path = folder.Path("calls.jsonl");
  Record(path, "first");
  const auto watched = ReplayClient::Create(path, "", ReplayFile::kWatched);
  const auto once = ReplayClient::Create(path, "", ReplayFile::kOnce);
  ASSERT_TRUE(watched);
  ASSERT_TRUE(once);
  Record(path, "second");
  EXPECT_THAT(AskOnce(**watched, "second").text, HasSubstr("to second"));
  EXPECT_EQ(AskOnce(**watched, "first").error, "");
  EXPECT_EQ(AskOnce(**once, "second").reason, NoAnswer::kNotRecorded);

  fs::rename(path, path + ".old");
  const LlmReply kept = AskOnce(**watched, "first");
  EXPECT_TRUE(kept.came());
  EXPECT_THAT(kept.error, HasSubstr("not read again: " + path));
  fs::rename(path + ".old", path);
  EXPECT_EQ(AskOnce(**watched, "first").error, "");
}

TEST(Recording, CallsWithoutAnAnswerAreNotKept) {
  const TempFolder folder;
  const std::string path = folder.Path("calls.jsonl");
  auto echo = std::make_unique<Echo>();
  echo->fails = true;
  auto client = RecordingClient::Create(std::move(echo), path, false);
  (*client)->Ask(Question("a"), {});
  EXPECT_EQ(ReadBytes(path), "");
}

TEST(Recording, KeepsPicturesOnceUnderTheirHash) {
  const TempFolder folder;
  const std::string path = folder.Path("calls.jsonl");
  auto client = RecordingClient::Create(std::make_unique<Echo>(), path, true);
  (*client)->Ask(Question("a"), {});
  (*client)->Ask(Question("b"), {});
  int pictures = 0;
  for (const auto& entry : fs::directory_iterator(path + ".images")) {
    ++pictures;
    EXPECT_EQ(ReadBytes(entry.path()), "\x89PNG");
  }
  EXPECT_EQ(pictures, 1);
}

TEST(LimitedClientTest, RefusesAtOnceOnARobotAndWaitsInAnEvaluation) {
  CallLimits limits;
  limits.calls_per_minute = 1;
  auto monitor = std::make_shared<CallMonitor>();
  LimitedClient robot(std::make_unique<Echo>(), limits, {}, AtLimit::kRefuse,
                      monitor);
  EXPECT_TRUE(robot.Ask(Question("a"), {}).came());
  const LlmReply refused = robot.Ask(Question("a"), {});
  EXPECT_EQ(refused.reason, NoAnswer::kRateLimit);
  EXPECT_THAT(refused.error, HasSubstr("the next call may go in 60 s"));
  EXPECT_EQ(monitor->figures().statistics.no_answers(), 1);

  LimitedClient evaluation(std::make_unique<Echo>(), limits, {}, AtLimit::kWait,
                           monitor);
  EXPECT_TRUE(evaluation.Ask(Question("a"), {}).came());
  std::stop_source stop;
  stop.request_stop();  // Else the test would wait for a minute.
  EXPECT_EQ(evaluation.Ask(Question("a"), stop.get_token()).reason,
            NoAnswer::kCancelled);
}

class ExchangeTest : public ::testing::Test {
 protected:
  fs::path FolderOf(const LlmRequest& request) const {
    return fs::path(options_.folder) /
           ExchangeName(client_.identity(), request);
  }

  TempFolder folder_;
  ExchangeOptions options_{.folder = folder_.Path("exchange"),
                           .model = "exchange",
                           .deadline_s = 20,
                           .poll_s = 0.005};
  ExchangeClient client_{options_};
};

TEST_F(ExchangeTest, AnAnswerThatIsThereIsNotAskedForAgain) {
  const LlmRequest request = Question("a");
  fs::create_directories(FolderOf(request));
  std::ofstream(FolderOf(request) / "answer.txt") << "Yes\n";
  const LlmReply reply = client_.Ask(request, {});
  EXPECT_EQ(reply.text, "Yes\n");
  EXPECT_FALSE(reply.timed) << "it says nothing of a model's time";
  EXPECT_FALSE(fs::exists(FolderOf(request) / "prompt.txt"));
}

TEST_F(ExchangeTest, EachQuestionAndRepeatHasAFolderWithASafeName) {
  const std::string name = ExchangeName(client_.identity(), Question("a"));
  EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-"),
            std::string::npos)
      << name;
  EXPECT_NE(name.front(), '-');
  EXPECT_NE(name, ExchangeName(client_.identity(), Question("b")));
  EXPECT_NE(name, ExchangeName(client_.identity(), Question("a", 1)));
}

TEST_F(ExchangeTest, CancellingEndsTheWaitAtOnce) {
  std::stop_source stop;
  std::jthread canceller([&] {
    const fs::path prompt = FolderOf(Question("a")) / "prompt.txt";
    while (!fs::exists(prompt)) std::this_thread::yield();
    stop.request_stop();
  });
  EXPECT_EQ(client_.Ask(Question("a"), stop.get_token()).reason,
            NoAnswer::kCancelled);
}

TEST_F(ExchangeTest, ATooLargeAnswerIsNone) {
  const LlmRequest request = Question("a");
  fs::create_directories(FolderOf(request));
  std::ofstream(FolderOf(request) / "answer.txt") << std::string(2u << 20, 'x');
  EXPECT_EQ(client_.Ask(request, {}).reason, NoAnswer::kTooLarge);
}

struct Encoding {
  std::string name;
  std::string bytes;
  std::string hint;
};

TEST_F(ExchangeTest, AnAnswerInAnotherEncodingGetsAHint) {
  const std::string utf16("\xff\xfeY\0e\0s\0", 8);
  for (const Encoding& tested :
       {Encoding{"utf16", utf16, "UTF-16"},
        Encoding{"utf16-without-mark", utf16.substr(2), "UTF-16"},
        Encoding{"utf16-big", std::string("\xfe\xff\0Y\0e\0s", 8), "UTF-16"},
        Encoding{"latin-1",
                 "Yes, \xe7"
                 "a va",
                 "Latin-1"}}) {
    const LlmRequest request = Question(tested.name);
    fs::create_directories(FolderOf(request));
    std::ofstream(FolderOf(request) / "answer.txt") << tested.bytes;
    const LlmReply reply = client_.Ask(request, {});
    EXPECT_EQ(reply.status, ReplyStatus::kAnswered);
    EXPECT_THAT(reply.error, HasSubstr(tested.hint)) << tested.name;
    EXPECT_THAT(reply.error, HasSubstr("save it as UTF-8")) << tested.name;
  }
  const LlmRequest request = Question("utf8");
  fs::create_directories(FolderOf(request));
  std::ofstream(FolderOf(request) / "answer.txt") << "\ufeffYes, \u00e7a va";
  EXPECT_EQ(client_.Ask(request, {}).error, "");
}

TEST_F(ExchangeTest, ABlankAnswerIsWaitedForAndThatIsSaidOnce) {
  for (const char* blank : {"", "\n", "\ufeff\r\n"}) {
    const LlmRequest request = Question(std::string("blank") + blank);
    const fs::path answer = FolderOf(request) / "answer.txt";
    fs::create_directories(FolderOf(request));
    std::ofstream(answer) << blank;
    CapturedErrors errors;
    options_.deadline_s = 0.1;
    const LlmReply none = ExchangeClient(options_).Ask(request, {});
    EXPECT_EQ(none.reason, NoAnswer::kDeadline);
    EXPECT_THAT(none.error, HasSubstr("it is empty"));
    EXPECT_TRUE(errors.Await(answer.string() + ": is empty")) << errors.Text();
    EXPECT_EQ(errors.Times("is empty"), 1) << errors.Text();
    std::ofstream(answer) << "Yes";
    EXPECT_EQ(client_.Ask(request, {}).text, "Yes");
  }
}

TEST_F(ExchangeTest, AnAnswerThatIsNoFileIsSaidOnce) {
  const LlmRequest request = Question("a");
  const fs::path answer = FolderOf(request) / "answer.txt";
  fs::create_directories(FolderOf(request));
  options_.deadline_s = 0.1;
  for (const bool pipe : {false, true}) {
    if (pipe) {
      ASSERT_EQ(mkfifo(answer.c_str(), 0600), 0);
    } else {
      fs::create_directory(answer);
    }
    CapturedErrors errors;
    const LlmReply none = ExchangeClient(options_).Ask(request, {});
    EXPECT_EQ(none.reason, NoAnswer::kDeadline);
    EXPECT_THAT(none.error, HasSubstr("is no regular file"));
    EXPECT_TRUE(errors.Await(answer.string() + ": is no regular file"))
        << errors.Text();
    EXPECT_EQ(errors.Times("is no regular file"), 1) << errors.Text();
    fs::remove(answer);
  }
}

TEST_F(ExchangeTest, ThinkingInAnAnswerIsLeftOut) {
  const LlmRequest request = Question("a");
  fs::create_directories(FolderOf(request));
  std::ofstream(FolderOf(request) / "answer.txt")
      << "No. [(1, 1)] hits a wall.\n</think>\n\nYes";
  EXPECT_EQ(client_.Ask(request, {}).text, "\n\nYes");
}

TEST_F(ExchangeTest, AFolderThatCannotBeWrittenIsSaid) {
  ExchangeOptions options = options_;
  options.folder = folder_.Write("file", "in the way");
  ExchangeClient client(options);
  const LlmReply reply = client.Ask(Question("a"), {});
  EXPECT_EQ(reply.reason, NoAnswer::kTransport);
  EXPECT_THAT(reply.error, HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace terra::advisor
