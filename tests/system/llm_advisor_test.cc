// The LLM advisor as a process, beside the deployed path as processes, and a
// model server that does everything wrong.
#include <chrono>
#include <iostream>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/digest.h"
#include "tests/support/scripted_llm_server.h"
#include "tests/system/bar_map.h"
#include "tests/system/robot.h"

namespace terra {
namespace {

using terra_msg::advice_t;
using terra_msg::deployed_t;
using terra_msg::status_t;
using testing::BarMap;
using testing::kBarGoal;
using testing::kBarStart;
using testing::kCheaperAnswer;
using testing::ReplyBody;
using testing::Robot;
using testing::ScriptedLlmServer;
using testing::ScriptedReply;

void StartDeployedPath(Robot& robot) {
  robot.Start("map");
  robot.Start("planner", {"--stride", "20"});
  robot.Start("verifier");
}

std::vector<std::string> ChatOptions(const ScriptedLlmServer& server,
                                     const std::string& deadline_s) {
  return {"--backend",  "chat",     "--base-url",         server.url(),
          "--deadline", deadline_s, "--breaker-failures", "0",
          "--retries",  "0"};
}

ScriptedReply Saying(const std::string& text) {
  ScriptedReply reply;
  reply.body = ReplyBody("chat", text);
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
  add("silence", kFailed, "deadline").silent = true;
  ScriptedReply& stall = add("stalled body", kFailed, "deadline");
  stall.body_share = 0.5;
  stall.stall = true;
  add("half a body", kFailed, "transport").body_share = 0.5;
  add("reset", kFailed, "transport").reset = true;
  for (const int status : {400, 401, 403, 404, 429, 500, 503, 529}) {
    add("status " + std::to_string(status), kFailed, "http_status").status =
        status;
  }
  add("hour-long wait", kFailed, "http_status") = [] {
    ScriptedReply reply = Saying("");
    reply.status = 429;
    reply.headers = {{"retry-after", "3600"}};
    return reply;
  }();
  for (const char* wait :
       {"retry-after-ms: 20", "retry-after: 1",
        "retry-after: Thu, 01 Jan 1970 00:00:00 GMT", "retry-after: soon"}) {
    const std::string header = wait;
    const std::size_t colon = header.find(':');
    ScriptedReply& busy = add("429 with " + header, kFailed, "http_status");
    busy.status = 429;
    busy.headers = {{header.substr(0, colon), header.substr(colon + 2)}};
  }
  add("redirect", kFailed, "http_status") = [] {
    ScriptedReply reply = Saying("");
    reply.status = 302;
    reply.headers = {{"location", "http://127.0.0.1:1/"}};
    return reply;
  }();
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
  return faults;
}

TEST(LlmAdvisor, EveryFaultIsNothingButMissingAdviceAndTheNextCallIsServed) {
  Robot robot(BarMap());
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
  StartDeployedPath(robot);
  robot.Start("model", ChatOptions(server, "2"));
  ASSERT_TRUE(robot.WaitForReady("model"));
  std::int64_t request_id = 100;
  for (const Fault& fault : Faults()) {
    SCOPED_TRACE(fault.name);
    set_next(fault.reply);
    const bus::Time asked = bus::Clock::now();
    const auto deployed = robot.Ask(++request_id, kBarStart, kBarGoal);
    ASSERT_TRUE(deployed);
    EXPECT_EQ(deployed->mode, deployed_t::MODE_BASELINE);
    const auto advice = robot.advice_bus().WaitFor<advice_t>(
        [request_id](const advice_t& message) {
          return message.request_id == request_id;
        });
    ASSERT_TRUE(advice);
    // Told, not judged: the deadline here is 2 s.
    std::cout << fault.name << ": " << advice->advice_error << "; ready after "
              << Milliseconds(bus::Clock::now() - asked) << " ms\n";
    EXPECT_EQ(int{advice->kind}, int{fault.kind});
    EXPECT_EQ(advice->advice_error.substr(0, fault.error.size()), fault.error);
    set_next(Saying(kCheaperAnswer));
    ASSERT_TRUE(robot.Ask(++request_id, kBarStart, kBarGoal));
    const auto answered = robot.advice_bus().WaitFor<advice_t>(
        [request_id](const advice_t& message) {
          return message.request_id == request_id;
        });
    ASSERT_TRUE(answered);
    EXPECT_EQ(int{answered->kind}, int{advice_t::KIND_PROPOSE})
        << answered->advice_error;
    const auto verdict = robot.deployed_bus().WaitFor<terra_msg::verdict_t>(
        [request_id](const terra_msg::verdict_t& message) {
          return message.request_id == request_id;
        });
    ASSERT_TRUE(verdict);
    EXPECT_EQ(int{verdict->code}, int{terra_msg::verdict_t::CODE_ACCEPTED});
    robot.deployed_bus().Forget();
    robot.advice_bus().Forget();
  }
}

TEST(LlmAdvisor, ANewRequestEndsTheCallForTheOldOneAtOnce) {
  Robot robot(BarMap());
  ScriptedReply silent;
  silent.silent = true;
  ScriptedLlmServer server({silent, Saying(kCheaperAnswer)});
  StartDeployedPath(robot);
  robot.Start("model", ChatOptions(server, "600"));
  ASSERT_TRUE(robot.Ask(11, kBarStart, kBarGoal));
  ASSERT_TRUE(server.WaitForRequests(1, 20));
  ASSERT_TRUE(robot.Ask(12, kBarStart, kBarGoal));
  EXPECT_TRUE(robot.WaitForDeployed(12, deployed_t::MODE_CANDIDATE))
      << "the call for request 11 would hang for ten minutes";
  for (const advice_t& advice : robot.advice_bus().Heard<advice_t>()) {
    EXPECT_EQ(advice.request_id, 12);
  }
}

TEST(LlmAdvisor, ANewMapEndsTheCallForTheOldOneAtOnce) {
  Robot robot(BarMap());
  ScriptedReply silent;
  silent.silent = true;
  ScriptedLlmServer server({silent, Saying(kCheaperAnswer)});
  StartDeployedPath(robot);
  robot.Start("model", ChatOptions(server, "600"));
  ASSERT_TRUE(robot.Ask(11, kBarStart, kBarGoal));
  ASSERT_TRUE(server.WaitForRequests(1, 20));
  ByteRaster ids = ByteRaster::Zero(120, 160);
  ids.block(30, 70, 90, 20).setConstant(9);
  const TerrainMap changed =
      TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
  robot.SaveMap(changed);
  const auto advice =
      robot.advice_bus().WaitFor<advice_t>([](const advice_t& message) {
        return message.request_id == 11;
      });
  ASSERT_TRUE(advice) << "the call for the old map would hang for ten minutes";
  EXPECT_EQ(advice->map_id, MapId(changed));
}

TEST(LlmAdvisor, HeartbeatTellsCallsTokensAndLatency) {
  Robot robot(BarMap());
  ScriptedLlmServer server({Saying(kCheaperAnswer)});
  StartDeployedPath(robot);
  robot.Start("model", ChatOptions(server, "10"));
  ASSERT_TRUE(robot.Ask(11, kBarStart, kBarGoal));
  const auto status =
      robot.deployed_bus().WaitFor<status_t>([](const status_t& message) {
        if (message.status_name != "model") return false;
        bool called = false;
        bool tokens = false;
        bool latency = false;
        for (std::size_t i = 0; i < message.counter_name.size(); ++i) {
          const std::string& name = message.counter_name[i];
          called |= name == "llm_calls" && message.counter_value[i] == 1;
          tokens |= name == "tokens_in" && message.counter_value[i] == 1000;
          latency |= name == "llm_p95_ms";
        }
        return called && tokens && latency;
      });
  EXPECT_TRUE(status);
}

TEST(LlmAdvisor, AMissingKeyIsSaidAtTheStart) {
  Robot robot(BarMap());
  testing::ChildProcess& advisor =
      robot.Start("model", {"--backend", "anthropic"});
  EXPECT_EQ(advisor.WaitForExit(testing::BusPeer::kPatience), 1);
  EXPECT_NE(advisor.output().find("ANTHROPIC_API_KEY"), std::string::npos);
}

}  // namespace
}  // namespace terra
