#include "bus/envelope.h"

#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "bus/message_texts.h"
#include "terrain/utf8.h"
#include "tests/filled_messages.h"

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

/// Keeps what is sent.
class Kept : public Transport {
 public:
  bool Publish(Channel, std::span<const std::uint8_t> bytes) override {
    last.assign(bytes.begin(), bytes.end());
    return bytes.size() <= kMaxMessageBytes;
  }

  std::vector<std::uint8_t> last;
};

/// Zero bytes, no UTF-8, control characters, and more than fits.
const std::string& Hostile() {
  static const std::string text = [] {
    std::string hostile("a\0b\xff\xe2\x82\x1b[2J\r\n\x7f", 14);
    return hostile + std::string(70'000, '\xe9');
  }();
  return text;
}

/// Sends a message and returns it as others hear it.
template <typename T>
T Heard(T message) {
  Kept kept;
  Outbox out(kept, 7);
  EXPECT_TRUE(out.Send(message)) << "too large";
  const Result<T> heard = Decode<T>(kept.last);
  EXPECT_TRUE(heard.ok());
  return heard.ok() ? *heard : T{};
}

void ExpectClean(const std::string& text) {
  EXPECT_TRUE(text.starts_with("a\uFFFDb\uFFFD")) << text.substr(0, 20);
  EXPECT_TRUE(IsUtf8(text));
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  EXPECT_EQ(text.find('\0'), std::string::npos);
}

// Calls visit(text, form, most bytes) for each text, those in lists too.
template <typename Message, typename Visit>
void EachSingleText(Message& message, Visit visit) {
  MessageTraits<std::remove_const_t<Message>>::EachText(
      message, [&](auto& texts, TextForm form, std::size_t max_bytes) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(texts)>,
                                     std::string>) {
          visit(texts, form, max_bytes);
        } else {
          for (auto& text : texts) visit(text, form, max_bytes);
        }
      });
}

// Whatever a model, a file or another process says, it can be told.
TEST(OutboxTest, NoTextMakesAMessageUnfitToBeSent) {
  int texts = 0;
  ForEachMessageType([&]<typename T>() {
    SCOPED_TRACE(T::getTypeName());
    auto message = testing::FilledMessage<T>();
    EachSingleText(message, [](std::string& text, auto...) {
      text = Hostile();
    });
    const T heard = Heard(message);
    EachSingleText(heard, [&](const std::string& text, TextForm form,
                              std::size_t max_bytes) {
      ++texts;
      ExpectClean(text);
      EXPECT_LE(text.size(), max_bytes);
      EXPECT_EQ(text.find('\n') != std::string::npos, form == TextForm::kBlock);
    });
  });
  EXPECT_GE(texts, 20);
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
