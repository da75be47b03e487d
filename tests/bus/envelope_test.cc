#include "bus/envelope.h"

#include <limits>

#include <gtest/gtest.h>

namespace terra::bus {
namespace {

using Sender = SenderTracker::Sender;

TEST(SenderTrackerTest, TheFirstSessionIsTaken) {
  SenderTracker tracker;
  EXPECT_EQ(tracker.Look(7, 1), Sender::kTookOver);
  EXPECT_EQ(tracker.Look(7, 2), Sender::kCurrent);
}

TEST(SenderTrackerTest, ANewSessionTakesOverAtOnceAndTheOldOneIsReported) {
  SenderTracker tracker;
  tracker.Look(7, 1);
  EXPECT_EQ(tracker.Look(8, 1), Sender::kTookOver);
  EXPECT_EQ(tracker.Look(7, 2), Sender::kReplaced);
  EXPECT_EQ(tracker.Look(8, 2), Sender::kCurrent);
  EXPECT_EQ(tracker.from_replaced(), 1);
}

TEST(SenderTrackerTest, AnOldOrRepeatedSeqIsIgnored) {
  SenderTracker tracker;
  tracker.Look(7, 5);
  EXPECT_EQ(tracker.Look(7, 5), Sender::kRepeated);
  EXPECT_EQ(tracker.Look(7, 4), Sender::kRepeated);
  EXPECT_FALSE(tracker.Accept(7, 3));
}

TEST(SenderTrackerTest, GapsInSeqAreCounted) {
  SenderTracker tracker;
  tracker.Look(7, 1);
  tracker.Look(7, 2);
  tracker.Look(7, 6);
  EXPECT_EQ(tracker.lost(), 3u);
}

TEST(SenderTrackerTest, JoiningLateIsNoLoss) {
  SenderTracker tracker;
  tracker.Look(7, 1000);
  EXPECT_EQ(tracker.lost(), 0u);
}

TEST(SenderTrackerTest, AnySeqIsTaken) {
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  SenderTracker tracker;
  for (const std::int64_t session : {7, 8}) {
    EXPECT_EQ(tracker.Look(session, kLeast), Sender::kTookOver);
    EXPECT_EQ(tracker.Look(session, kMost), Sender::kCurrent);
    EXPECT_EQ(tracker.Look(session, kMost), Sender::kRepeated);
  }
}

TEST(RandomIdTest, IsNeverZeroAndDiffers) {
  EXPECT_NE(RandomId(), 0);
  EXPECT_NE(RandomId(), RandomId());
}

// Keeps what is sent.
class Recorder : public Transport {
 public:
  bool Publish(Channel channel, std::span<const std::uint8_t> bytes) override {
    channels.push_back(channel);
    last.assign(bytes.begin(), bytes.end());
    return true;
  }
  std::vector<Channel> channels;
  std::vector<std::uint8_t> last;
};

TEST(OutboxTest, StampsSessionAndCountsPerChannel) {
  Recorder recorder;
  Outbox out(recorder, 99);
  terra_msg::pose_t pose{};
  terra_msg::map_request_t request{};
  out.Send(pose);
  out.Send(request);
  out.Send(pose);
  const auto sent = Decode<terra_msg::pose_t>(recorder.last);
  ASSERT_TRUE(sent.ok());
  EXPECT_EQ(sent->session, 99);
  EXPECT_EQ(sent->seq, 2);
  EXPECT_GT(sent->utime, 0);
}

}  // namespace
}  // namespace terra::bus
