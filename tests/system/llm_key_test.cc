// The API key goes to the provider, and nowhere else: a whole set of processes
// with a logger, an evaluation and single calls, against a server that repeats
// the key wherever a reply has room for it.
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/secrets.h"
#include "tests/support/bar_map.h"
#include "tests/support/scripted_llm_server.h"
#include "tests/system/robot.h"

namespace terra {
namespace {

namespace fs = std::filesystem;
using terra_msg::advice_t;
using testing::BarMap;
using testing::ChildProcess;
using testing::ErrorBody;
using testing::kBarGoal;
using testing::kBarStart;
using testing::kCheaperAnswer;
using testing::ProgramPath;
using testing::ReadBytes;
using testing::ReplyBody;
using testing::Robot;
using testing::RunToEnd;
using testing::ScriptedLlmServer;
using testing::ScriptedReply;

constexpr const char* kSecret = "sk-secret-0123456789";

/// Replies that hold the key in every field that is read, or kept.
std::vector<ScriptedReply> RepliesWithKey() {
  const std::string secret = kSecret;
  std::vector<ScriptedReply> replies(3);
  replies[0].status = 401;
  replies[0].body = ErrorBody("openai", "Incorrect API key: " + secret);
  replies[1].body = ReplyBody("openai", kCheaperAnswer + (" by " + secret));
  for (std::size_t at = 0;
       (at = replies[1].body.find("scripted", at)) != std::string::npos;) {
    replies[1].body.replace(at, 8, secret);
  }
  replies[2].body = "<html>" + secret + "</html>";
  for (ScriptedReply& reply : replies) {
    reply.headers = {{"x-request-id", secret}, {"server", secret}};
  }
  return replies;
}

/// Files below a folder that hold the text.
std::vector<std::string> FilesWith(const std::string& folder,
                                   const std::string& text) {
  std::vector<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() &&
        ReadBytes(entry.path()).find(text) != std::string::npos) {
      found.push_back(entry.path());
    }
  }
  return found;
}

class KeyOfTheModel : public ::testing::Test {
 protected:
  void SetUp() override { setenv("OPENAI_API_KEY", kSecret, 1); }
  void TearDown() override { unsetenv("OPENAI_API_KEY"); }

  void SetNext(const ScriptedReply& reply) {
    const std::scoped_lock lock(mutex_);
    next_ = reply;
  }
  /// What a program wrote, kept for the search at the end.
  int Run(std::vector<std::string> command) {
    command.front() = ProgramPath(command.front());
    const auto result = RunToEnd(command);
    outputs_ += result.output;
    return result.exit_code;
  }
  std::vector<std::string> Model() const {
    return {"--backend", "openai", "--base-url", server_.url(),
            "--retries", "0",      "--model",    "gpt-5.5"};
  }

  Robot robot_{BarMap()};  // First: it may move to a network of its own.
  std::mutex mutex_;
  ScriptedReply next_;
  ScriptedLlmServer server_{[this](const testing::SeenRequest&) {
    const std::scoped_lock lock(mutex_);
    return next_;
  }};
  std::string outputs_;
};

TEST_F(KeyOfTheModel, IsInNoMessageLogRecordingResultOrOutput) {
  const std::string folder = fs::path(robot_.map_path()).parent_path();
  robot_.Start("map");
  robot_.Start("planner", {"--stride", "20"});
  robot_.Start("verifier");
  std::vector<std::string> logger = {ProgramPath("terra-logger"), "--out",
                                     folder + "/log"};
  for (const std::string& option : robot_.BusOptions()) {
    logger.push_back(option);
  }
  ChildProcess log(logger);
  std::vector<std::string> options = Model();
  options.insert(options.end(), {"--record", folder + "/bus.jsonl"});
  ChildProcess& advisor = robot_.Start("model", options);
  ASSERT_TRUE(robot_.WaitForReady("model"));
  std::int64_t request_id = 10;
  for (const ScriptedReply& reply : RepliesWithKey()) {
    SetNext(reply);
    ASSERT_TRUE(robot_.Ask(++request_id, kBarStart, kBarGoal));
    ASSERT_TRUE(robot_.advice_bus().WaitFor<advice_t>(
        [request_id](const advice_t& message) {
          return message.request_id == request_id;
        }));
    // Also what the heartbeat says of it.
    ASSERT_TRUE(robot_.advice_bus().WaitFor<terra_msg::status_t>(
        [](const terra_msg::status_t& message) {
          return message.status_name == "model" && !message.last_error.empty();
        }));

    std::vector<std::string> advise = {
        "terra",    "advise", "--map",  robot_.map_path(),
        "--start",  "5,60",   "--goal", "155,60",
        "--stride", "20",     "--json"};
    const std::vector<std::string> model = Model();
    advise.insert(advise.end(), model.begin(), model.end());
    advise.insert(advise.end(), {"--record", folder + "/once.jsonl"});
    Run(advise);
  }
  EXPECT_EQ(Run({"terra", "bench", "generate", "--subset", "easy", "--count",
                 "1", "--seed", "7", "--out", folder + "/data"}),
            0);
  SetNext(RepliesWithKey()[1]);
  std::vector<std::string> bench = {"terra",
                                    "bench",
                                    "run",
                                    "--dataset",
                                    folder + "/data",
                                    "--method",
                                    "advisor",
                                    "--out",
                                    folder + "/run",
                                    "--record",
                                    folder + "/bench.jsonl"};
  const std::vector<std::string> model = Model();
  bench.insert(bench.end(), model.begin(), model.end());
  EXPECT_EQ(Run(bench), 0);
  std::vector<std::string> print = {"terra-advisor", "--print-config"};
  print.insert(print.end(), model.begin(), model.end());
  EXPECT_EQ(Run(print), 0);

  EXPECT_EQ(log.Terminate(), 0);
  EXPECT_EQ(advisor.Terminate(), 0);
  outputs_ += log.output() + advisor.output();
  ASSERT_GE(server_.request_count(), 7) << outputs_;
  EXPECT_EQ(server_.requests().front().Header("authorization"),
            std::string("Bearer ") + kSecret);
  EXPECT_EQ(FilesWith(folder, kSecret), std::vector<std::string>{});
  EXPECT_EQ(outputs_.find(kSecret), std::string::npos) << outputs_;
  // The search looks where the key would be.
  EXPECT_GE(FilesWith(folder, "[key]").size(), 4u)
      << "log, three recordings, results";
  EXPECT_NE(outputs_.find("[key]"), std::string::npos);
}

// What others of the same user could read.
TEST_F(KeyOfTheModel, IsInNobodysEnvironmentOnceHeRuns) {
  for (const char* variable : kApiKeyVariables) {
    setenv(variable, (kSecret + std::string(variable)).c_str(), 1);
  }
  const std::vector<std::string> others = {"map", "planner", "verifier"};
  const std::vector<std::string> advisors = {"search", "shortcut",  "openai",
                                             "gemini", "anthropic", "chat"};
  for (const std::string& name : others) robot_.Start(name);
  for (const std::string& backend : advisors) {
    robot_.Start(backend, {"--backend", backend, "--base-url", server_.url(),
                           "--model", "any"});
  }
  for (const char* variable : kApiKeyVariables) unsetenv(variable);
  const auto read_of = [&](const std::string& name, const std::string& file) {
    EXPECT_TRUE(robot_.WaitForReady(name)) << name;
    return ReadBytes("/proc/" + std::to_string(robot_.process(name).pid()) +
                     "/" + file);
  };
  for (const auto& names : {others, advisors}) {
    for (const std::string& name : names) {
      const std::string environment = read_of(name, "environ");
      EXPECT_NE(environment.find("API_KEY="), std::string::npos) << name;
      EXPECT_EQ(environment.find(kSecret), std::string::npos) << name;
    }
  }
  for (const std::string& name : advisors) {
    EXPECT_THAT(read_of(name, "limits"),
                ::testing::ContainsRegex("Max core file size +0 +0 "))
        << name;
  }
}

TEST_F(KeyOfTheModel, OnTheCommandLineIsRefusedWithoutBeingRepeated) {
  for (const char* program : {"terra-advisor", "terra"}) {
    std::vector<std::string> command = {program};
    if (program == std::string("terra")) command.push_back("advise");
    command.insert(command.end(), {"--api-key", kSecret});
    EXPECT_EQ(Run(command), 2) << program;
  }
  EXPECT_EQ(outputs_.find(kSecret), std::string::npos) << outputs_;
}

}  // namespace
}  // namespace terra
