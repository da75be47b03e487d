// Who may speak for a gate on the journal's port, and how much.
#include "logger/journal_tap.h"

#include <cstdint>

#include <gtest/gtest.h>

namespace terra::logger {
namespace {

constexpr std::int64_t kSecond = 1'000'000;

bus::SenderAddress Socket(int port) {
  return {.address = 0x7f000001, .port = static_cast<std::uint16_t>(port)};
}

TEST(JournalSpeakers, WhoSpokeFirstSpeaksForASession) {
  JournalSpeakers speakers;
  EXPECT_TRUE(speakers.MaySpeak(Socket(1), 4711));
  EXPECT_FALSE(speakers.MaySpeak(Socket(2), 4711));
  EXPECT_TRUE(speakers.MaySpeak(Socket(2), 4712));
  EXPECT_TRUE(speakers.MaySpeak(Socket(1), 4711));
  EXPECT_FALSE(speakers.MaySpeak(Socket(1), 4712));
}

// A gate that was started again has another socket and another session.
TEST(JournalSpeakers, ManySessionsPushOutWhoSpokeLongestAgo) {
  JournalSpeakers speakers;
  constexpr int kMost = static_cast<int>(JournalSpeakers::kMaxSpeakers);
  for (int port = 1; port <= kMost; ++port) {
    EXPECT_TRUE(speakers.MaySpeak(Socket(port), port));
  }
  EXPECT_FALSE(speakers.MaySpeak(Socket(kMost + 1), 1));
  EXPECT_TRUE(speakers.MaySpeak(Socket(1), 1));
  EXPECT_TRUE(speakers.MaySpeak(Socket(kMost + 1), kMost + 1));
  EXPECT_FALSE(speakers.MaySpeak(Socket(kMost + 2), 1)) << "spoke just now";
  EXPECT_TRUE(speakers.MaySpeak(Socket(kMost + 2), 2)) << "was forgotten";
}

// Returns how many bytes get through in a second of far too many.
std::int64_t SaidInASecond(JournalSpeakers& speakers, int port,
                           bool changes_session) {
  constexpr std::int64_t kBytes = 50'000;
  std::int64_t said = 0;
  for (std::int64_t now = 0; now < kSecond; now += 1'000) {
    const std::int64_t session = changes_session ? 1'000 * port + now : port;
    EXPECT_TRUE(speakers.MaySpeak(Socket(port), session));
    if (speakers.MaySay(kBytes, now)) said += kBytes;
  }
  return said;
}

TEST(JournalSpeakers, OneSocketSaysNoMoreThanAGateDoes) {
  constexpr std::int64_t kMost =
      JournalSpeakers::kOfOne.bytes_per_s + JournalSpeakers::kOfOne.burst;
  for (const bool changes_session : {false, true}) {
    JournalSpeakers speakers;
    const std::int64_t said = SaidInASecond(speakers, 1, changes_session);
    EXPECT_LE(said, kMost);
    EXPECT_GE(said, JournalSpeakers::kOfOne.bytes_per_s);
    EXPECT_TRUE(speakers.MaySpeak(Socket(2), -1));
    EXPECT_TRUE(speakers.MaySay(50'000, kSecond)) << "another gate";
  }
}

TEST(JournalSpeakers, AllTogetherAreBounded) {
  JournalSpeakers speakers;
  std::int64_t said = 0;
  for (int port = 1; port <= 100; ++port) {
    said += SaidInASecond(speakers, port, false);
  }
  EXPECT_LE(said, JournalSpeakers::kOfAll.bytes_per_s +
                      JournalSpeakers::kOfAll.burst);
}

}  // namespace
}  // namespace terra::logger
