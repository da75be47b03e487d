#include "logger/log_reader.h"

#include <cstdio>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/random_map.h"
#include "tests/support/temp_folder.h"

namespace terra::logger {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Bytes = std::vector<std::uint8_t>;

// Events named A, B, C, ... of 10, 11, 12, ... bytes of data.
Bytes SmallLog(int events) {
  Bytes bytes;
  for (int i = 0; i < events; ++i) {
    const std::string channel(1, static_cast<char>('A' + i));
    const Bytes data(static_cast<std::size_t>(10 + i),
                     static_cast<std::uint8_t>(i));
    AppendLogEvent(bytes, {i, 1'000 * i, channel, data});
  }
  return bytes;
}

std::size_t EventSize(int index) {
  return kLogHeaderBytes + 1 + 10 + static_cast<std::size_t>(index);
}

std::string ChannelsIn(LogReader& reader) {
  std::string channels;
  while (const auto item = reader.Next()) {
    channels += item->event.channel;
  }
  return channels;
}

// Writes the bytes into a file of that folder and opens it.
Result<LogReader> OpenFile(const testing::TempFolder& folder,
                           const Bytes& bytes) {
  return LogReader::Open(
      folder.Write("some.lcmlog", std::string(bytes.begin(), bytes.end())));
}

TEST(LogReader, GivesBackWhatWasAppended) {
  const Bytes bytes = SmallLog(3);
  LogReader reader(bytes);
  for (int i = 0; i < 3; ++i) {
    const auto item = reader.Next();
    ASSERT_TRUE(item);
    EXPECT_EQ(item->event.number, i);
    EXPECT_EQ(item->event.time_us, 1'000 * i);
    EXPECT_EQ(item->event.data.size(), static_cast<std::size_t>(10 + i));
    EXPECT_EQ(item->raw.size(), EventSize(i));
  }
  EXPECT_FALSE(reader.Next());
  EXPECT_THAT(reader.damage(), IsEmpty());
}

TEST(LogReader, GoesOnAfterAWipedMagicNumber) {
  Bytes bytes = SmallLog(5);
  bytes[EventSize(0) + EventSize(1)] = 0;
  LogReader reader(bytes);
  EXPECT_EQ(ChannelsIn(reader), "ABDE");
  ASSERT_EQ(reader.damage().size(), 1U);
  EXPECT_EQ(reader.damage()[0].offset,
            static_cast<std::int64_t>(EventSize(0) + EventSize(1)));
  EXPECT_EQ(reader.damage()[0].bytes, static_cast<std::int64_t>(EventSize(2)));
  EXPECT_FALSE(reader.damage()[0].torn_end);
}

TEST(LogReader, ALengthThatSwallowsTheNextEventCostsOneEventOnly) {
  Bytes bytes = SmallLog(5);
  bytes[EventSize(0) + 27] = 11 + 5;
  LogReader reader(bytes);
  EXPECT_EQ(ChannelsIn(reader), "ACDE");
}

TEST(LogReader, HugeAndNegativeLengthsCostOneEventOnly) {
  for (const int at : {20, 24}) {
    for (const int high : {0x7f, 0xff, 0x80, 0x01}) {
      Bytes bytes = SmallLog(4);
      bytes[EventSize(0) + static_cast<std::size_t>(at)] =
          static_cast<std::uint8_t>(high);
      LogReader reader(bytes);
      EXPECT_EQ(ChannelsIn(reader), "ACD");
      EXPECT_EQ(reader.num_damaged_bytes(),
                static_cast<std::int64_t>(EventSize(1)));
    }
  }
}

TEST(LogReader, SkipsForeignBytesBetweenEvents) {
  Bytes bytes = SmallLog(2);
  Bytes second = SmallLog(3);
  bytes.insert(bytes.end(), 777, 0);
  bytes.insert(bytes.end(), second.begin(), second.end());
  LogReader reader(bytes);
  EXPECT_EQ(ChannelsIn(reader), "ABABC");
  EXPECT_EQ(reader.num_damaged_bytes(), 777);
}

TEST(LogReader, EveryTruncationGivesTheWholeEventsAndATornEnd) {
  const Bytes whole = SmallLog(3);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes bytes(whole.begin(),
                      whole.begin() + static_cast<std::ptrdiff_t>(size));
    LogReader reader(bytes);
    std::size_t expected = 0;
    std::size_t end = 0;
    while (end + EventSize(static_cast<int>(expected)) <= size) {
      end += EventSize(static_cast<int>(expected++));
    }
    EXPECT_EQ(ChannelsIn(reader).size(), expected);
    if (end == size) {
      EXPECT_THAT(reader.damage(), IsEmpty());
    } else {
      ASSERT_EQ(reader.damage().size(), 1U) << size;
      EXPECT_TRUE(reader.damage()[0].torn_end);
      EXPECT_EQ(reader.damage()[0].bytes,
                static_cast<std::int64_t>(size - end));
    }
  }
}

TEST(LogReader, EveryFlippedBitCostsAtMostOneEvent) {
  const Bytes whole = SmallLog(6);
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Bytes bytes = whole;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    LogReader reader(bytes);
    EXPECT_GE(ChannelsIn(reader).size(), 5U) << "byte " << bit / 8;
  }
}

TEST(LogReader, AFileReadsAsItsBytesDo) {
  // Larger than the window, with damage of every kind.
  terra::testing::Random random(3);
  Bytes bytes;
  for (int i = 0; i < 400; ++i) {
    AppendLogEvent(bytes,
                   {i, i, "C",
                    Bytes(static_cast<std::size_t>(random.Int(0, 20'000)),
                          std::uint8_t{0xED})});
  }
  for (int i = 0; i < 200; ++i) {
    bytes[static_cast<std::size_t>(
        random.Int(0, static_cast<int>(bytes.size()) - 1))] ^= 0xff;
  }
  for (std::size_t at = 0; at < bytes.size(); at += 100'000) {
    bytes[at] ^= 0x01;
  }
  LogReader memory(bytes);
  const testing::TempFolder folder;
  auto file = OpenFile(folder, bytes);
  ASSERT_TRUE(file) << file.error().message;
  while (true) {
    const auto a = memory.Next();
    const auto b = file->Next();
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) break;
    ASSERT_EQ(a->offset, b->offset);
    ASSERT_TRUE(
        std::equal(a->raw.begin(), a->raw.end(), b->raw.begin(), b->raw.end()));
  }
  EXPECT_EQ(memory.num_damaged_bytes(), file->num_damaged_bytes());
  EXPECT_EQ(memory.num_damaged_places(), file->num_damaged_places());
}

TEST(LogReader, AFileOfLargeClaimsTakesLinearTime) {
  // Headers that each claim 4 MB and lie within what the one before claims:
  // reading all that is claimed would take hours.
  Bytes bytes;
  const Bytes none;
  while (bytes.size() < 12'000'000) {
    const std::size_t begin = bytes.size();
    AppendLogEvent(bytes, {0, 0, "C", none});
    bytes[begin + 25] = 0x40;
    bytes.push_back(0);
  }
  const testing::TempFolder folder;
  auto file = OpenFile(folder, bytes);
  ASSERT_TRUE(file);
  std::int64_t in_events = 0;
  while (const auto item = file->Next()) in_events += std::ssize(item->raw);
  EXPECT_EQ(in_events + file->num_damaged_bytes(), std::ssize(bytes));
}

TEST(LogReader, SaysWhyAFileCannotBeRead) {
  const auto missing = LogReader::Open("/nonexistent/x.lcmlog");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);
  const testing::TempFolder made;
  const auto folder = LogReader::Open(made.Path(""));
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().code, ErrorCode::kUnavailable);
  EXPECT_THAT(folder.error().message, ::testing::HasSubstr("not a file"));
}

}  // namespace
}  // namespace terra::logger
