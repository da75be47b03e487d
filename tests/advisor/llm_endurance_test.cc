// A long life with a model server that fails in every way, over and over.
#include <malloc.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "advisor/llm_backend.h"
#include "terrain/builtin_legends.h"
#include "terrain/route_cost.h"
#include "tests/support/scripted_llm_server.h"

namespace terra::advisor {
namespace {

using testing::ErrorBody;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ReplyBody;
using testing::ScriptedLlmServer;
using testing::ScriptedReply;

constexpr const char* kSecret = "sk-secret-0123456789";
constexpr const char* kProposal = "No. [(1, 6), (8, 1), (14, 6)]";

ScriptedReply Saying(const std::string& text) {
  ScriptedReply reply;
  reply.body = ReplyBody("openai", text);
  return reply;
}

ScriptedReply Failing(int status) {
  ScriptedReply reply;
  reply.status = status;
  reply.body = ErrorBody("openai", std::string("not with ") + kSecret);
  return reply;
}

/// The first two are answers with a use, the next four attempts without, the
/// rest are no answers.
std::vector<ScriptedReply> Script() {
  std::vector<ScriptedReply> script = {Saying("Yes"), Saying(kProposal),
                                       Saying(""), Saying("No. [(1, 6), (8"),
                                       Saying(std::string("No ") + kSecret)};
  script.emplace_back().body =
      R"({"status":"incomplete","output":[],
          "incomplete_details":{"reason":"max_output_tokens"}})";
  for (const int status : {401, 429, 500, 302}) {
    script.push_back(Failing(status));
  }
  script.emplace_back().reset = true;
  ScriptedReply half = Saying("Yes");
  half.body_share = 0.5;
  script.push_back(half);
  script.emplace_back().body = "<html>\xff\xfe</html>";
  return script;
}

// What was allocated and not freed. What a process has from the system also
// grows by what the allocator keeps for its threads. Sanitizers have an
// allocator of their own, for which this is 0, and find leaks themselves.
std::size_t BytesInUse() {
  const struct mallinfo2 info = ::mallinfo2();
  return info.uordblks + info.hblkhd;
}

long OpenFiles() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                       std::filesystem::directory_iterator());
}

TEST(LlmEndurance, TenThousandCallsLeaveNothingBehindAndGiveNothingAway) {
  ByteRaster ids = ByteRaster::Zero(12, 16);
  ids.block(3, 7, 9, 2).setConstant(10);
  const TerrainMap map =
      TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
  const Route baseline = {{1, 6}, {14, 6}};
  const double cost = WalkRoute(map, baseline).cost;
  const AdviceTask task{map,      77,  1, baseline.front(), baseline.back(),
                        baseline, cost};
  const std::vector<ScriptedReply> script = Script();
  // Not counted by requests: where a server closes a connection that was used
  // before, the library sends the request again by itself.
  std::atomic<std::size_t> current{0};
  ScriptedLlmServer server([&](const testing::SeenRequest&) {
    return script[current % script.size()];
  });
  LlmBackendOptions options;
  options.service.backend = "openai";
  options.service.provider.base_url = server.url();
  options.service.provider.retry.max_retries = 0;
  options.service.limits.breaker_failures = 0;
  options.service.prices = {"scripted=1:10"};
  setenv("OPENAI_API_KEY", kSecret, 1);
  auto backend = LlmBackend::Create(options);
  unsetenv("OPENAI_API_KEY");
  ASSERT_TRUE(backend.ok()) << backend.error().message;

  constexpr int kCalls = 10'000;
  std::size_t memory = 0;
  long files = 0;
  std::map<AnswerKind, int> kinds;
  for (int call = 0; call < kCalls; ++call) {
    if (call == kCalls / 10) files = OpenFiles();
    if (call == kCalls / 2) memory = BytesInUse();
    current = static_cast<std::size_t>(call);
    const AdviceAnswer answer = (*backend)->Advise(task, {});
    ++kinds[answer.kind];
    ASSERT_THAT(answer.error + answer.answer_text + answer.model,
                Not(HasSubstr(kSecret)));
  }
  const int rounds = kCalls / static_cast<int>(script.size());
  EXPECT_NEAR(kinds[AnswerKind::kRetain], rounds, 1);
  EXPECT_NEAR(kinds[AnswerKind::kPropose], rounds, 1);
  EXPECT_NEAR(kinds[AnswerKind::kMalformed], 4 * rounds, 4);
  EXPECT_GE(server.request_count(), kCalls);
  EXPECT_LE(OpenFiles(), files + 4) << "connections of the server's own";
  constexpr std::size_t kUnderWay = 64'000;  // 13 bytes for each call.
  EXPECT_LT(BytesInUse(), memory + kUnderWay);
}

TEST(LlmEndurance, SpendStopsAtTheBudgetWhateverIsAsked) {
  ByteRaster ids = ByteRaster::Zero(12, 16);
  const TerrainMap map =
      TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
  const Route baseline = {{1, 6}, {14, 6}};
  const AdviceTask task{map,      77, 1, baseline.front(), baseline.back(),
                        baseline, 13};
  ScriptedLlmServer server({Saying("Yes")});
  LlmBackendOptions options;
  options.service.backend = "openai";
  options.service.provider.base_url = server.url();
  options.service.provider.settings.model = "scripted";
  // 1,000 tokens in and 20 out: 0.0012 dollars a call.
  options.service.prices = {"scripted=1:10"};
  options.service.limits.spend_per_hour_usd = 0.1;
  auto backend = LlmBackend::Create(options);
  ASSERT_TRUE(backend.ok()) << backend.error().message;
  for (int call = 0; call < 1'000; ++call) (*backend)->Advise(task, {});
  EXPECT_EQ(server.request_count(), 84)
      << "the call that passes the limit ends";
  EXPECT_THAT((*backend)->Advise(task, {}).error, HasSubstr("spend_limit"));
}

}  // namespace
}  // namespace terra::advisor
