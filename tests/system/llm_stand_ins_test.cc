// Who may stand in for a model, through real processes: a simulated model that
// speaks the providers' forms, and people or programs that answer from files.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "advisor/http_transport.h"
#include "tests/support/bar_map.h"
#include "tests/system/robot.h"

namespace terra {
namespace {

namespace fs = std::filesystem;
using terra_msg::advice_t;
using terra_msg::deployed_t;
using testing::BarMap;
using testing::ChildProcess;
using ::testing::HasSubstr;
using testing::kBarGoal;
using testing::kBarStart;
using testing::kCheaperAnswer;
using testing::ReadBytes;
using testing::Robot;

// For what appears on disk: nothing tells of that but looking.
bool WaitUntil(const std::function<bool()>& holds) {
  const auto until = bus::Clock::now() + testing::BusPeer::kPatience;
  while (!holds()) {
    if (bus::Clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

class SimulatedModel : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(testing::ProgramPath("terra-llm-sim"))) {
      GTEST_SKIP() << "terra-llm-sim was not built (no cpp-httplib)";
    }
    const std::string port_file = robot_.folder().Path("port");
    server_ = std::make_unique<ChildProcess>(
        std::vector<std::string>{testing::ProgramPath("terra-llm-sim"),
                                 "--latency", "0", "--port-file", port_file});
    ASSERT_TRUE(WaitUntil([&port_file] {
      return ReadBytes(port_file).ends_with("\n");
    }));
    url_ =
        "http://127.0.0.1:" + std::to_string(std::stoi(ReadBytes(port_file)));
  }

  Robot robot_{BarMap()};
  std::unique_ptr<ChildProcess> server_;
  std::string url_;
};

TEST_F(SimulatedModel, ItsRouteIsDeployed) {
  robot_.Start("map");
  robot_.Start("planner", {"--stride", "20"});
  robot_.Start("verifier");
  robot_.Start("model", {"--backend", "chat", "--base-url", url_ + "/v1"});
  ASSERT_TRUE(robot_.Ask(11, kBarStart, kBarGoal));
  const auto deployed = robot_.WaitForDeployed(11, deployed_t::MODE_CANDIDATE);
  ASSERT_TRUE(deployed);
  EXPECT_LT(deployed->deployed_cost, deployed->baseline_cost);
  const auto advice =
      robot_.advice_bus().WaitFor<advice_t>([](const advice_t& message) {
        return message.request_id == 11;
      });
  ASSERT_TRUE(advice);
  EXPECT_EQ(advice->model, "SIMULATED terra-llm-sim")
      << "nobody takes it for a real one";
}

TEST_F(SimulatedModel, SpeaksTheFormsOfAllProvidersAndReadsAllPictures) {
  for (const char* backend : {"openai", "anthropic", "gemini", "chat"}) {
    for (const char* picture : {"native", "axes"}) {
      const auto advised = testing::RunToEnd(
          {testing::ProgramPath("terra"), "advise", "--map", robot_.map_path(),
           "--start", "5,60", "--goal", "155,60", "--stride", "20", "--backend",
           backend, "--base-url", url_, "--picture", picture, "--json"});
      EXPECT_EQ(advised.exit_code, 0) << backend << picture;
      EXPECT_THAT(advised.output, HasSubstr(R"("code":"accepted")"))
          << backend << picture;
    }
  }
}

TEST_F(SimulatedModel, WithoutItsPortFileItDoesNotServe) {
  const auto ended =
      testing::RunToEnd({testing::ProgramPath("terra-llm-sim"), "--port-file",
                         robot_.folder().Path("no/such/folder/port")});
  EXPECT_EQ(ended.exit_code, 1);
}

TEST_F(SimulatedModel, RefusesWhatIsNoQuestionAndGoesOn) {
  advisor::HttpTransport http;
  const auto status = [&](const std::string& path, const std::string& body) {
    advisor::HttpRequest request;
    request.url = url_ + path;
    request.body = body;
    return http.Post(request, {}).status;
  };
  EXPECT_EQ(status("/v1/chat/completions", "\xff{\"messages\":["), 400);
  EXPECT_EQ(status("/v1/messages", R"({"messages":[]})"), 400);
  EXPECT_EQ(status("/", "{}"), 400);
  EXPECT_TRUE(server_->running());
  EXPECT_EQ(server_->Terminate(), 0);
}

/// Waits for a question in the folder; returns its own folder.
fs::path WaitForQuestion(const fs::path& folder) {
  fs::path question;
  EXPECT_TRUE(WaitUntil([&] {
    std::error_code not_yet;
    for (const auto& entry : fs::directory_iterator(folder, not_yet)) {
      if (fs::exists(entry.path() / "prompt.txt")) question = entry.path();
    }
    return !question.empty();
  }));
  return question;
}

void Answer(const fs::path& question, const std::string& bytes) {
  std::ofstream(question / "part") << bytes;
  fs::rename(question / "part", question / "answer.txt");
}

TEST(Exchange, WhoeverAnswersFromFilesAdvisesTheRobot) {
  Robot robot(BarMap());
  const fs::path folder = robot.folder().Path("exchange");
  robot.Start("map");
  robot.Start("planner", {"--stride", "20"});
  robot.Start("verifier");
  robot.Start("person", {"--backend", "exchange", "--exchange", folder});
  const auto first = robot.Ask(11, kBarStart, kBarGoal);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->mode, deployed_t::MODE_BASELINE);

  const fs::path question = WaitForQuestion(folder);
  ASSERT_FALSE(question.empty());
  EXPECT_NE(question.filename().string().front(), '-') << "awkward in a shell";
  EXPECT_THAT(ReadBytes(folder / "README.txt"), HasSubstr("answer.txt"));
  EXPECT_THAT(ReadBytes(question / "prompt.txt"), HasSubstr("Start: (5, 60)"));
  for (const char* name : {"image-1.png", "image-2.png", "image-3.png"}) {
    EXPECT_EQ(ReadBytes(question / name).substr(1, 3), "PNG") << name;
  }

  Answer(question, std::string(kCheaperAnswer) + "\n");
  const auto deployed = robot.WaitForDeployed(11, deployed_t::MODE_CANDIDATE);
  ASSERT_TRUE(deployed);
  EXPECT_EQ(deployed->source, "person");
}

struct WrittenAnswer {
  std::string name;
  std::string bytes;
  std::string shown;  ///< What the advice says it was.
  std::string hint;
};

// The answer stays in its folder: an advisor that it ended would end at each
// start.
TEST(Exchange, NoAnswerEndsTheAdvisorNowOrWhenItStartsAgain) {
  Robot robot(BarMap());
  const fs::path folder = robot.folder().Path("exchange");
  const auto start = [&] {
    robot.Start("person", {"--backend", "exchange", "--exchange", folder});
  };
  robot.Start("map");
  robot.Start("planner", {"--stride", "20"});
  robot.Start("verifier");
  start();
  std::int64_t request_id = 10;
  ASSERT_TRUE(robot.Ask(++request_id, kBarStart, kBarGoal));
  const fs::path question = WaitForQuestion(folder);
  ASSERT_FALSE(question.empty());
  for (const WrittenAnswer& answer :
       {WrittenAnswer{"zero byte",
                      std::string("No. [(5, 60), (70\0, 28), (155, 60)]", 35),
                      "(70\uFFFD, 28)", "zero bytes"},
        WrittenAnswer{"UTF-16", std::string("\xff\xfeY\0e\0s\0", 8),
                      "\uFFFD\uFFFDY\uFFFDe", "UTF-16"},
        WrittenAnswer{"Latin-1",
                      "Oui, \xe7"
                      "a va",
                      "Oui, \uFFFDa", "Latin-1"},
        WrittenAnswer{"terminal", "\x1b[2J", "\uFFFD[2J", "no_list"}}) {
    SCOPED_TRACE(answer.name);
    robot.Kill("person");
    Answer(question, answer.bytes);
    for (int starts = 0; starts < 2; ++starts) {
      robot.advice_bus().Forget();
      start();
      const auto advice =
          robot.advice_bus().WaitFor<advice_t>([](const advice_t& message) {
            return message.advisor == "person";
          });
      ASSERT_TRUE(advice);
      EXPECT_EQ(int{advice->kind}, int{advice_t::KIND_MALFORMED});
      EXPECT_THAT(advice->answer_text, HasSubstr(answer.shown));
      EXPECT_THAT(advice->advice_error, HasSubstr(answer.hint));
      EXPECT_TRUE(robot.process("person").running());
      robot.Kill("person");
    }
  }
  Answer(question, kCheaperAnswer);
  start();
  EXPECT_TRUE(robot.WaitForDeployed(request_id, deployed_t::MODE_CANDIDATE));
}

}  // namespace
}  // namespace terra
