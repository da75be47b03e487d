// The LLM advisor as a process, beside the deployed path as processes, and a
// model server that does everything wrong.
#include <chrono>
#include <iostream>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/digest.h"
#include "tests/support/bar_map.h"
#include "tests/support/scripted_llm_server.h"
#include "tests/system/robot.h"

namespace terra {
namespace {

using terra_msg::advice_t;
using terra_msg::deployed_t;
using terra_msg::status_t;
using terra_msg::verdict_t;
using testing::BarMap;
using testing::kBarGoal;
using testing::kBarStart;
using testing::kCheaperAnswer;
using testing::ReplyBody;
using testing::Robot;
using testing::ScriptedLlmServer;
using testing::ScriptedReply;

ScriptedReply Saying(const std::string& text) {
  ScriptedReply reply;
  reply.body = ReplyBody("chat", text);
  return reply;
}

ScriptedReply Silence() {
  ScriptedReply reply;
  reply.silent = true;
  return reply;
}

std::int64_t Milliseconds(bus::Duration duration) {
  return std::chrono::duration_cast<std::chrono::milliseconds>(duration)
      .count();
}

struct Fault {
  std::string name;
  ScriptedReply reply;
  std::int8_t kind;   // What the advice says of it.
  std::string error;  // Its first word.
};

std::vector<Fault> Faults() {
  std::vector<Fault> faults;
  const auto add = [&faults](const std::string& name, std::int8_t kind,
                             const std::string& error) -> ScriptedReply& {
    faults.push_back({name, Saying(kCheaperAnswer), kind, error});
    return faults.back().reply;
  };
  constexpr std::int8_t kFailed = advice_t::KIND_FAILED;
  constexpr std::int8_t kMalformed = advice_t::KIND_MALFORMED;
  add("silence", kFailed, "deadline") = Silence();
  ScriptedReply& stall = add("stalled body", kFailed, "deadline");
  stall.body_share = 0.5;
  stall.stall = true;
  add("half a body", kFailed, "transport").body_share = 0.5;
  add("reset", kFailed, "transport").reset = true;
  for (const int status : {400, 401, 403, 404, 429, 500, 503, 529}) {
    add("status " + std::to_string(status), kFailed, "http_status").status =
        status;
  }
  for (const char* wait :
       {"retry-after-ms: 20", "retry-after: 1", "retry-after: 3600",
        "retry-after: Thu, 01 Jan 1970 00:00:00 GMT", "retry-after: soon"}) {
    const std::string header = wait;
    const std::size_t colon = header.find(':');
    ScriptedReply& busy = add("429 with " + header, kFailed, "http_status");
    busy.status = 429;
    busy.headers = {{header.substr(0, colon), header.substr(colon + 2)}};
  }
  ScriptedReply& redirect = add("redirect", kFailed, "http_status");
  redirect.status = 302;
  redirect.headers = {{"location", "http://127.0.0.1:1/"}};
  ScriptedReply& cut = add("half of the chunks", kFailed, "transport");
  cut.framing = testing::Framing::kChunked;
  cut.body_share = 0.5;
  // What is no fault: the route comes.
  constexpr std::int8_t kPropose = advice_t::KIND_PROPOSE;
  add("wrong content type", kPropose, "").content_type = "text/html";
  add("late answer", kPropose, "").delay_s = 0.3;
  add("page of HTML", kFailed, "bad_reply").body = "<html>busy</html>";
  add("no UTF-8", kFailed, "bad_reply").body = "{\"choices\":\"\xff\xfe\"}";
  add("huge body", kFailed, "too_large").body = std::string(12u << 20, ' ');
  add("refusal", kMalformed, "refused").body =
      R"({"choices":[{"finish_reason":"content_filter",
          "message":{"content":null}}]})";
  add("truncation", kMalformed, "truncated").body =
      R"({"choices":[{"finish_reason":"length",
          "message":{"content":"No. [(5, 60), (7"}}]})";
  add("empty answer", kMalformed, "empty") = Saying("");
  add("chatter", kMalformed, "no_list") = Saying("What a nice map!");
  add("fractions", kMalformed, "not_an_integer") =
      Saying("No. [(5.0, 60), (155, 60)]");
  // What no message may hold: JSON has escapes for all of it.
  add("zero byte after a Yes", kMalformed, "yes_not_alone") =
      Saying(std::string("Yes\0", 4));
  add("zero byte in a route", kMalformed, "not_a_pair") =
      Saying(std::string("No. [(5, 60), (70\0, 28), (155, 60)]", 35));
  add("control characters", kMalformed, "no_list") =
      Saying("\x1b[2J\x1b]0;title\x07 \u009b \x7f");
  add("endless answer", kMalformed, "too_long") =
      Saying(std::string(70'000, 'x') + "\u20ac");
  add("zero byte in a model's name", kPropose, "").body =
      R"({"model":"a\u0000b\u001b[2J","choices":[{"message":{"content":)"
      R"("No. [(5, 60), (70, 28), (90, 28), (155, 60)]"}}]})";
  add("zero byte in a refusal", kMalformed, "refused").body =
      R"({"choices":[{"finish_reason":"stop",
          "message":{"content":"","refusal":"a\u0000b"}}]})";
  ScriptedReply& error = add("zero byte in an error", kFailed, "http_status");
  error.status = 400;
  error.body = R"({"error":{"message":"a\u0000b"}})";
  add("failure in place of the answer", kFailed, "bad_reply").body =
      R"({"choices":[{"finish_reason":"error","error":{"code":502,
          "message":"no instance"},"message":{"content":"No"}}]})";
  add("no choice", kFailed, "bad_reply").body = R"({"choices":[]})";
  add("thinking without its beginning", kPropose, "") = Saying(
      std::string("No. [(5, 60)] hits a wall.\n</think>\n\n") + kCheaperAnswer);
  return faults;
}

/// The deployed path and an advisor that asks a server of the test's.
class LlmAdvisor : public ::testing::Test {
 protected:
  void StartAround(const ScriptedLlmServer& server,
                   const std::string& deadline_s) {
    robot_.Start("map");
    robot_.Start("planner", {"--stride", "20"});
    robot_.Start("verifier");
    robot_.Start("model",
                 {"--backend", "chat", "--base-url", server.url(), "--deadline",
                  deadline_s, "--breaker-failures", "0", "--retries", "0"});
  }

  /// The request is served at once, whatever the advisor does.
  std::optional<deployed_t> Ask(std::int64_t request_id) {
    return robot_.Ask(request_id, kBarStart, kBarGoal);
  }

  std::optional<advice_t> AdviceOn(std::int64_t request_id) {
    return robot_.advice_bus().WaitFor<advice_t>(
        [request_id](const advice_t& message) {
          return message.request_id == request_id;
        });
  }

  std::optional<verdict_t> VerdictOn(std::int64_t request_id) {
    return robot_.deployed_bus().WaitFor<verdict_t>(
        [request_id](const verdict_t& message) {
          return message.request_id == request_id;
        });
  }

  /// Asks, and waits until the advisor hangs in its call for ten minutes.
  void HangOn(std::int64_t request_id, ScriptedLlmServer& server) {
    StartAround(server, "600");
    ASSERT_TRUE(Ask(request_id));
    ASSERT_TRUE(server.WaitForRequests(1, 20));
  }

  // First: it may move to a network of its own.
  Robot robot_{BarMap()};
};

TEST_F(LlmAdvisor, EveryFaultIsNothingButMissingAdviceAndTheNextCallIsServed) {
  std::mutex mutex;
  ScriptedReply next;
  const auto set_next = [&](const ScriptedReply& reply) {
    const std::scoped_lock lock(mutex);
    next = reply;
  };
  ScriptedLlmServer server([&](const testing::SeenRequest&) {
    const std::scoped_lock lock(mutex);
    return next;
  });
  StartAround(server, "5");
  ASSERT_TRUE(robot_.WaitForReady("model"));
  std::int64_t request_id = 100;
  for (const Fault& fault : Faults()) {
    SCOPED_TRACE(fault.name);
    set_next(fault.reply);
    const bus::Time asked = bus::Clock::now();
    const auto deployed = Ask(++request_id);
    ASSERT_TRUE(deployed);
    EXPECT_EQ(deployed->mode, deployed_t::MODE_BASELINE);
    const auto advice = AdviceOn(request_id);
    ASSERT_TRUE(advice);
    // Told, not judged: the deadline here is 5 s.
    std::cout << fault.name << ": " << advice->advice_error << "; ready after "
              << Milliseconds(bus::Clock::now() - asked) << " ms\n";
    EXPECT_EQ(int{advice->kind}, int{fault.kind});
    EXPECT_EQ(advice->advice_error.substr(0, fault.error.size()), fault.error);

    set_next(Saying(kCheaperAnswer));
    ASSERT_TRUE(Ask(++request_id));
    const auto answered = AdviceOn(request_id);
    ASSERT_TRUE(answered);
    EXPECT_EQ(int{answered->kind}, int{advice_t::KIND_PROPOSE})
        << answered->advice_error;
    const auto verdict = VerdictOn(request_id);
    ASSERT_TRUE(verdict);
    EXPECT_EQ(int{verdict->code}, int{verdict_t::CODE_ACCEPTED});
    robot_.deployed_bus().Forget();
    robot_.advice_bus().Forget();
  }
}

TEST_F(LlmAdvisor, ANewRequestEndsTheCallForTheOldOneAtOnce) {
  ScriptedLlmServer server({Silence(), Saying(kCheaperAnswer)});
  ASSERT_NO_FATAL_FAILURE(HangOn(11, server));
  ASSERT_TRUE(Ask(12));
  EXPECT_TRUE(robot_.WaitForDeployed(12, deployed_t::MODE_CANDIDATE));
  for (const advice_t& advice : robot_.advice_bus().Heard<advice_t>()) {
    EXPECT_EQ(advice.request_id, 12);
  }
}

TEST_F(LlmAdvisor, ANewMapEndsTheCallForTheOldOneAtOnce) {
  ScriptedLlmServer server({Silence(), Saying(kCheaperAnswer)});
  ASSERT_NO_FATAL_FAILURE(HangOn(11, server));
  ByteRaster ids = ByteRaster::Zero(120, 160);
  ids.block(30, 70, 90, 20).setConstant(9);
  const TerrainMap changed =
      TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
  robot_.SaveMap(changed);
  const auto advice = AdviceOn(11);
  ASSERT_TRUE(advice);
  EXPECT_EQ(advice->map_id, MapId(changed));
}

/// -1 = there is none of that name.
std::int64_t CounterOf(const status_t& status, const std::string& name) {
  for (std::size_t i = 0; i < status.counter_name.size(); ++i) {
    if (status.counter_name[i] == name) return status.counter_value[i];
  }
  return -1;
}

TEST_F(LlmAdvisor, HeartbeatTellsCallsTokensAndLatency) {
  ScriptedReply late = Saying(kCheaperAnswer);
  late.delay_s = 0.05;
  ScriptedLlmServer server({late});
  StartAround(server, "10");
  ASSERT_TRUE(Ask(11));
  EXPECT_TRUE(
      robot_.advice_bus().WaitFor<status_t>([](const status_t& message) {
        return message.status_name == "model" &&
               CounterOf(message, "llm_calls") == 1 &&
               CounterOf(message, "tokens_in") == 1000 &&
               CounterOf(message, "tokens_out") == 20 &&
               CounterOf(message, "llm_p95_ms") > 0;
      }));
}

TEST_F(LlmAdvisor, ANameThatNoMessageMayHoldIsRefused) {
  for (const std::string name : {"a\nb", "\x1b[2J", "caf\xe9"}) {
    const auto ended = testing::RunToEnd(
        {testing::ProgramPath("terra-advisor"), "--name", name});
    EXPECT_EQ(ended.exit_code, 2) << ended.output;
    EXPECT_NE(ended.output.find("UTF-8"), std::string::npos) << ended.output;
  }
}

TEST_F(LlmAdvisor, AMissingKeyIsSaidAtTheStart) {
  testing::ChildProcess& advisor =
      robot_.Start("model", {"--backend", "anthropic"});
  EXPECT_EQ(advisor.WaitForExit(testing::BusPeer::kPatience), 1);
  EXPECT_NE(advisor.output().find("ANTHROPIC_API_KEY"), std::string::npos);
}

}  // namespace
}  // namespace terra
