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
  EXPECT_FALSE(judged.Add(event));
}

TEST(JudgedAdviceTest, WhateverAdviceSaysMakesItNew) {
  JudgedAdvice judged(100);
  AdviceEvent event;
  EXPECT_TRUE(judged.Add(event));
  const auto is_new_once = [&] {
    return !judged.Has(event) && judged.Add(event) && judged.Has(event) &&
           !judged.Add(event);
  };
  event.advisor = "another name";
  EXPECT_TRUE(is_new_once());
  event.kind = AdviceKind::kRetain;
  EXPECT_TRUE(is_new_once());
  event.anchor.session = 7;
  EXPECT_TRUE(is_new_once());
  event.anchor.route_seq = 7;
  EXPECT_TRUE(is_new_once());
  event.anchor.index = 7;
  EXPECT_TRUE(is_new_once());
  event.anchor.cell = {7, 0};
  EXPECT_TRUE(is_new_once());
  event.anchor.cell = {7, 7};
  EXPECT_TRUE(is_new_once());
  event.waypoints = {{1, 0}};
  EXPECT_TRUE(is_new_once());
  event.waypoints = {{1, 1}};
  EXPECT_TRUE(is_new_once());
  event.waypoints.push_back({0, 0});
  EXPECT_TRUE(is_new_once());
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
