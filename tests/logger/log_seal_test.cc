#include "logger/log_seal.h"

#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "logger/log_channels.h"
#include "logger/log_writer.h"
#include "tests/support/temp_folder.h"

namespace terra::logger {
namespace {

using terra_msg::log_mark_t;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Bytes = std::vector<std::uint8_t>;

// A closed log with four messages in two sealed stretches.
Bytes WriteSmallLog() {
  const testing::TempFolder folder;
  const std::string path = folder.Path("small.lcmlog");
  auto writer = LogWriter::Create({path, "R1_TERRA_LOG", 42, 0});
  EXPECT_TRUE(writer);
  writer->Seal(1'000, log_mark_t::KIND_HEADER, "header");
  for (int i = 0; i < 4; ++i) {
    writer->Append(2'000 + i, "R1_TERRA_POSE", Bytes(20, std::uint8_t{9}));
    if (i == 1) {
      writer->Seal(2'100, log_mark_t::KIND_CHECKSUM);
      EXPECT_TRUE(writer->Sync());
    }
  }
  writer->Seal(3'000, log_mark_t::KIND_END);
  EXPECT_TRUE(writer->Sync());
  const std::string bytes = testing::ReadBytes(path);
  return Bytes(bytes.begin(), bytes.end());
}

struct Checked {
  SealChecker seals;
  std::int64_t damaged_bytes = 0;
  int events = 0;

  bool Whole() const {
    return damaged_bytes == 0 && seals.num_broken() == 0 && seals.closed() &&
           seals.unsealed_bytes() == 0 && seals.header();
  }
};

Checked Check(const Bytes& bytes) {
  Checked checked;
  LogReader reader(bytes);
  while (const auto item = reader.Next()) {
    checked.seals.Take(*item);
    ++checked.events;
  }
  checked.seals.Finish(reader.size());
  checked.damaged_bytes = reader.num_damaged_bytes();
  return checked;
}

TEST(LogSeal, AClosedLogIsWhole) {
  const Checked checked = Check(WriteSmallLog());
  EXPECT_TRUE(checked.Whole());
  EXPECT_EQ(checked.seals.good(), 3);
  EXPECT_EQ(checked.events, 7);
  EXPECT_EQ(checked.seals.header()->session, 42);
  EXPECT_EQ(checked.seals.header()->mark_text, "header");
}

TEST(LogSeal, EveryFlippedBitIsNoticed) {
  const Bytes whole = WriteSmallLog();
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Bytes bytes = whole;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    const Checked checked = Check(bytes);
    EXPECT_FALSE(checked.Whole()) << "byte " << bit / 8 << " bit " << bit % 8;
    EXPECT_GE(checked.events, 6);
  }
}

TEST(LogSeal, EveryOtherValueOfEveryByteIsNoticed) {
  const Bytes whole = WriteSmallLog();
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (int change = 1; change < 256; change += 2) {
      Bytes bytes = whole;
      bytes[at] = static_cast<std::uint8_t>(bytes[at] + change);
      EXPECT_FALSE(Check(bytes).Whole()) << "byte " << at;
    }
  }
}

TEST(LogSeal, EveryTruncationIsNoticed) {
  const Bytes whole = WriteSmallLog();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(Check({whole.begin(),
                        whole.begin() + static_cast<std::ptrdiff_t>(size)})
                     .Whole())
        << size;
  }
}

TEST(LogSeal, AWholeEventThatIsMissingOrDoubledIsNoticed) {
  const Bytes whole = WriteSmallLog();
  LogReader reader(whole);
  while (const auto item = reader.Next()) {
    const auto begin =
        whole.begin() + static_cast<std::ptrdiff_t>(item->offset);
    const auto end = begin + std::ssize(item->raw);
    Bytes without(whole.begin(), begin);
    without.insert(without.end(), end, whole.end());
    EXPECT_FALSE(Check(without).Whole());
    Bytes doubled(whole.begin(), end);
    doubled.insert(doubled.end(), begin, whole.end());
    EXPECT_FALSE(Check(doubled).Whole());
  }
}

TEST(LogSeal, NamesTheStretchThatWasChanged) {
  Bytes bytes = WriteSmallLog();
  LogReader reader(bytes);
  const auto header = reader.Next();
  const auto first = static_cast<std::int64_t>(header->raw.size());
  bytes[static_cast<std::size_t>(first) + kLogHeaderBytes + 20] ^= 1;
  const Checked checked = Check(bytes);
  ASSERT_EQ(checked.seals.broken().size(), 1U);
  EXPECT_EQ(checked.seals.broken()[0].offset, first);
  EXPECT_THAT(checked.seals.broken()[0].reason, HasSubstr("checksum"));
  EXPECT_EQ(checked.seals.good(), 2);
}

TEST(LogSeal, ALogOfAnotherRecorderHasNoSealsAndNoFault) {
  Bytes bytes;
  AppendLogEvent(bytes, {0, 5, "POSE", Bytes(8)});
  const Checked checked = Check(bytes);
  EXPECT_FALSE(checked.seals.sealed());
  EXPECT_THAT(checked.seals.broken(), IsEmpty());
  EXPECT_EQ(checked.seals.unsealed_bytes(), std::ssize(bytes));
}

TEST(LogSeal, OnlyTheRobotsOwnMarksAreMarks) {
  EXPECT_EQ(ChannelOf("TERRA_LOG"), bus::Channel::kLog);
  EXPECT_EQ(ChannelOf("R1_TERRA_LOG"), bus::Channel::kLog);
  EXPECT_FALSE(ChannelOf("XTERRA_LOG"));
  EXPECT_FALSE(ChannelOf("TERRA_LOGS"));
}

}  // namespace
}  // namespace terra::logger
