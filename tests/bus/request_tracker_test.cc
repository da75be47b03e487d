#include "bus/request_tracker.h"

#include <gtest/gtest.h>

namespace terra::bus {
namespace {

terra_msg::plan_request_t Go(std::int64_t id) {
  terra_msg::plan_request_t message{};
  message.request_id = id;
  message.action = terra_msg::plan_request_t::ACTION_GO;
  message.start_x = 1;
  message.goal_x = 9;
  return message;
}

terra_msg::plan_request_t Cancel(std::int64_t id) {
  terra_msg::plan_request_t message = Go(id);
  message.action = terra_msg::plan_request_t::ACTION_CANCEL;
  return message;
}

RequestInForce Carried(std::int64_t id) {
  return RequestInForce{id, false, 0, {1, 0}, {9, 0}};
}

TEST(RequestTrackerTest, AnUnseenRequestReplacesTheCurrentOne) {
  RequestTracker tracker;
  EXPECT_TRUE(tracker.OnRequest(Go(1)));
  EXPECT_FALSE(tracker.OnRequest(Go(1)));
  EXPECT_TRUE(tracker.OnRequest(Go(2)));
  EXPECT_EQ(tracker.current().request_id, 2);
}

TEST(RequestTrackerTest, AReplacedRequestNeverComesBack) {
  RequestTracker tracker;
  tracker.OnRequest(Go(1));
  tracker.OnRequest(Go(2));
  EXPECT_FALSE(tracker.OnRequest(Go(1)));
  EXPECT_FALSE(tracker.OnAnswer(Carried(1), 70));
  EXPECT_EQ(tracker.current().request_id, 2);
}

TEST(RequestTrackerTest, ARestartedProcessTakesTheRequestFromTheAnswer) {
  RequestTracker tracker;
  EXPECT_TRUE(tracker.OnAnswer(Carried(5), 70));
  EXPECT_EQ(tracker.current().request_id, 5);
  EXPECT_EQ(tracker.current().goal, (Cell{9, 0}));
}

TEST(RequestTrackerTest, AnAnswerThatIsOnlyLateDoesNotUndoANewRequest) {
  RequestTracker tracker;
  tracker.OnRequest(Go(6));
  EXPECT_FALSE(tracker.OnAnswer(Carried(5), 70));
  EXPECT_EQ(tracker.current().request_id, 6);
}

TEST(RequestTrackerTest, FollowsASenderThatWentOnToAnotherRequest) {
  RequestTracker tracker;
  tracker.OnRequest(Go(6));
  EXPECT_FALSE(tracker.OnAnswer(Carried(6), 70));
  EXPECT_TRUE(tracker.OnAnswer(Carried(7), 70));
  EXPECT_EQ(tracker.current().request_id, 7);
}

TEST(RequestTrackerTest, CancelHoldsAgainstRepeatedGo) {
  RequestTracker tracker;
  tracker.OnRequest(Go(1));
  EXPECT_TRUE(tracker.OnRequest(Cancel(1)));
  EXPECT_TRUE(tracker.current().cancelled);
  EXPECT_FALSE(tracker.OnRequest(Go(1)));
  EXPECT_TRUE(tracker.current().cancelled);
}

TEST(RequestTrackerTest, CancelThatOvertakesItsRequestHoldsToo) {
  RequestTracker tracker;
  tracker.OnRequest(Go(1));
  EXPECT_FALSE(tracker.OnRequest(Cancel(2)));
  EXPECT_FALSE(tracker.OnRequest(Go(2)));
  EXPECT_EQ(tracker.current().request_id, 1);
}

TEST(RequestTrackerTest, RequestsWithoutIdOrActionAreIgnored) {
  RequestTracker tracker;
  EXPECT_FALSE(tracker.OnRequest(Go(0)));
  terra_msg::plan_request_t strange = Go(1);
  strange.action = 9;
  EXPECT_FALSE(tracker.OnRequest(strange));
  EXPECT_FALSE(tracker.current().any());
}

}  // namespace
}  // namespace terra::bus
