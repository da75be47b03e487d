#include "verifier/gate_memory.h"

#include <gtest/gtest.h>

namespace terra::verifier {
namespace {

AdviceEvent Attempt(std::int64_t attempt) {
  AdviceEvent event;
  event.attempt = attempt;
  return event;
}

TEST(JudgedAdviceTest, EachPartOfTheKeyMakesAdviceNew) {
  JudgedAdvice judged(100);
  AdviceEvent event;
  EXPECT_TRUE(judged.Add(event));
  EXPECT_FALSE(judged.Add(event));
  for (std::int64_t AdviceEvent::*part :
       {&AdviceEvent::request_id, &AdviceEvent::map_id,
        &AdviceEvent::baseline_digest, &AdviceEvent::session,
        &AdviceEvent::attempt}) {
    event.*part = 7;
    EXPECT_TRUE(judged.Add(event));
  }
  event.candidate = 7;
  EXPECT_TRUE(judged.Add(event));
  event.advisor = "another name";
  event.kind = AdviceKind::kRetain;
  event.anchor.index = 7;
  event.waypoints = {{1, 1}};
  EXPECT_FALSE(judged.Add(event)) << "what it says does not count";
}

TEST(JudgedAdviceTest, RemembersSoManyAndForgetsWhatWasSilentForLongest) {
  JudgedAdvice judged(2);
  EXPECT_TRUE(judged.Add(Attempt(1)));
  EXPECT_TRUE(judged.Add(Attempt(2)));
  EXPECT_FALSE(judged.Add(Attempt(1)));
  EXPECT_TRUE(judged.Add(Attempt(3)));
  EXPECT_FALSE(judged.Add(Attempt(1)));
  EXPECT_TRUE(judged.Add(Attempt(2))) << "forgotten";
}

}  // namespace
}  // namespace terra::verifier
