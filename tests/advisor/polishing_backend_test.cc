#include "advisor/polishing_backend.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "terrain/route_cost.h"
#include "terrain/route_text.h"
#include "tests/support/ascii_map.h"

namespace terra::advisor {
namespace {

// Gives one answer, whatever it is asked.
class FixedBackend : public Backend {
 public:
  explicit FixedBackend(AdviceAnswer answer) : answer_(std::move(answer)) {}
  std::string name() const override { return "fixed"; }
  std::string method() const override { return "test"; }
  AdviceAnswer Advise(const AdviceTask&, std::stop_token) override {
    return answer_;
  }

 private:
  AdviceAnswer answer_;
};

class PolishingBackendTest : public ::testing::Test {
 protected:
  AdviceAnswer Ask(AnswerKind kind, const std::vector<Route>& routes,
                   bool stopped = false) {
    AdviceAnswer inner;
    inner.kind = kind;
    for (const Route& route : routes) inner.candidates.push_back({route});
    PolishingBackend backend(std::make_unique<FixedBackend>(inner));
    EXPECT_EQ(backend.name(), "fixed");
    EXPECT_EQ(backend.method(), "test");
    std::stop_source stop;
    if (stopped) stop.request_stop();
    return backend.Advise({map_, 1, 2, baseline_.front(), baseline_.back(),
                           baseline_, WalkRoute(map_, baseline_).cost},
                          stop.get_token());
  }

  const TerrainMap map_ = testing::MapFromAscii({
      "111111111",
      "11#####11",
      "119999911",
      "119999911",
      "119999911",
  });
  const Route baseline_ = {{0, 3}, {8, 3}};
};

TEST_F(PolishingBackendTest, PutsPolishedFormsBeforeTheRawOnes) {
  // Through the obstacle; and a valid one that is dearer than it need be.
  const Route blocked = {{0, 3}, {4, 1}, {8, 3}};
  const Route wide = {{0, 3}, {0, 0}, {8, 0}, {8, 3}};
  const AdviceAnswer answer = Ask(AnswerKind::kPropose, {blocked, wide});
  // Both polished forms are the same route, which comes once.
  ASSERT_EQ(answer.candidates.size(), 3U);
  EXPECT_TRUE(answer.candidates[0].polished);
  EXPECT_DOUBLE_EQ(WalkRoute(map_, answer.candidates[0].route).cost,
                   6 + 4 * std::sqrt(2.0));
  EXPECT_FALSE(answer.candidates[1].polished);
  EXPECT_EQ(answer.candidates[1].route, blocked);
  EXPECT_FALSE(answer.candidates[2].polished);
  EXPECT_EQ(answer.candidates[2].route, wide);
}

TEST_F(PolishingBackendTest, LeavesOtherAnswersAlone) {
  for (const AnswerKind kind :
       {AnswerKind::kRetain, AnswerKind::kMalformed, AnswerKind::kFailed}) {
    const AdviceAnswer answer = Ask(kind, {});
    EXPECT_EQ(answer.kind, kind);
    EXPECT_TRUE(answer.candidates.empty());
  }
}

TEST_F(PolishingBackendTest, ToldToStopSendsTheAnswerAsItIs) {
  const AdviceAnswer answer =
      Ask(AnswerKind::kPropose, {{{0, 3}, {4, 1}, {8, 3}}}, true);
  ASSERT_EQ(answer.candidates.size(), 1U);
  EXPECT_FALSE(answer.candidates[0].polished);
}

}  // namespace
}  // namespace terra::advisor
