#include "bus/wire.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include "bus/messages.h"
#include "tests/bus/sample_messages.h"
#include "tests/support/random_map.h"

namespace terra::bus {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ::terra::testing::Random;
using ::terra::testing::StampedSample;

template <typename T>
class EveryMessageTypeTest : public ::testing::Test {};

struct TypeNames {
  template <typename T>
  static std::string GetName(int) {
    return T::getTypeName();
  }
};

using AllTypes = ::testing::Types<
    terra_msg::map_header_t, terra_msg::map_tile_t, terra_msg::map_request_t,
    terra_msg::plan_request_t, terra_msg::baseline_t, terra_msg::advice_t,
    terra_msg::verdict_t, terra_msg::deployed_t, terra_msg::pose_t,
    terra_msg::status_t, terra_msg::config_t, terra_msg::log_mark_t,
    terra_msg::gate_step_t>;
TYPED_TEST_SUITE(EveryMessageTypeTest, AllTypes, TypeNames);

// The bytes that logs and other programs hold. They change only with a type,
// and a type changes only under a new name. Made by this test when
// TERRA_UPDATE_GOLDEN is set.
TYPED_TEST(EveryMessageTypeTest, EncodesToItsGoldenBytes) {
  const std::string path = std::string(TERRA_GOLDEN_FOLDER) + "/" +
                           TypeParam::getTypeName() + ".bin";
  const Bytes bytes = Encode(StampedSample<TypeParam>());
  if (std::getenv("TERRA_UPDATE_GOLDEN") != nullptr) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  std::ifstream file(path, std::ios::binary);
  ASSERT_TRUE(file) << path;
  const Bytes golden{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(bytes, golden);
}

TYPED_TEST(EveryMessageTypeTest, ComesBackEqualFromItsBytes) {
  const Bytes bytes = Encode(StampedSample<TypeParam>());
  const Result<TypeParam> decoded = Decode<TypeParam>(bytes);
  ASSERT_TRUE(decoded.ok()) << decoded.error().message;
  EXPECT_EQ(Encode(*decoded), bytes);
}

TYPED_TEST(EveryMessageTypeTest, IsRefusedWhenCutAnywhere) {
  const Bytes bytes = Encode(StampedSample<TypeParam>());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(Decode<TypeParam>(std::span(bytes).first(size)).ok()) << size;
  }
}

TYPED_TEST(EveryMessageTypeTest, IsRefusedWithBytesTooMany) {
  Bytes bytes = Encode(StampedSample<TypeParam>());
  bytes.push_back(0);
  EXPECT_FALSE(Decode<TypeParam>(bytes).ok());
}

TYPED_TEST(EveryMessageTypeTest, IsRefusedWithAnotherFingerprint) {
  Bytes bytes = Encode(StampedSample<TypeParam>());
  bytes[3] ^= 1;
  EXPECT_FALSE(Decode<TypeParam>(bytes).ok());
}

// Any four bytes may be a count or a length: whatever is written over them, the
// decoder neither crashes nor takes memory for it (LCM's own does both).
TYPED_TEST(EveryMessageTypeTest, SurvivesHostileCountsEverywhere) {
  const Bytes good = Encode(StampedSample<TypeParam>());
  const std::vector<std::uint32_t> hostile = {
      0, 1, 0xFFFFFFFF, 0xFFFFFFFB, 0x7FFFFFFF, 200'000'000, 2049, 0x80000000};
  for (std::size_t at = 8; at + 4 <= good.size(); ++at) {
    for (const std::uint32_t value : hostile) {
      Bytes bytes = good;
      for (std::size_t i = 0; i < 4; ++i) {
        bytes[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
      }
      const Result<TypeParam> decoded = Decode<TypeParam>(bytes);
      if (decoded) {
        EXPECT_EQ(Encode(*decoded), bytes);
      }
    }
  }
}

TYPED_TEST(EveryMessageTypeTest, SurvivesRandomDamage) {
  const Bytes good = Encode(StampedSample<TypeParam>());
  Random random(7);
  const int size = static_cast<int>(good.size());
  for (int i = 0; i < 2000; ++i) {
    Bytes bytes = good;
    for (int flips = random.Int(1, 8); flips > 0; --flips) {
      bytes[static_cast<std::size_t>(random.Int(8, size - 1))] =
          static_cast<std::uint8_t>(random.Int(0, 255));
    }
    bytes.resize(static_cast<std::size_t>(random.Int(8, size)));
    const Result<TypeParam> decoded = Decode<TypeParam>(bytes);
    if (decoded) {
      EXPECT_EQ(Encode(*decoded), bytes);
    }
  }
}

// Bytes with nothing behind them: whoever reads on is ended by the system.
class BytesAtTheEnd {
 public:
  explicit BytesAtTheEnd(std::span<const std::uint8_t> bytes)
      : page_(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))) {
    TERRA_REQUIRE(bytes.size() <= page_);
    void* pages = mmap(nullptr, 2 * page_, PROT_READ | PROT_WRITE,
                       MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    TERRA_REQUIRE(pages != MAP_FAILED);
    begin_ = static_cast<std::uint8_t*>(pages);
    TERRA_REQUIRE(mprotect(begin_ + page_, page_, PROT_NONE) == 0);
    bytes_ = {begin_ + page_ - bytes.size(), bytes.size()};
    std::ranges::copy(bytes, bytes_.begin());
  }
  BytesAtTheEnd(const BytesAtTheEnd&) = delete;
  BytesAtTheEnd& operator=(const BytesAtTheEnd&) = delete;
  ~BytesAtTheEnd() { munmap(begin_, 2 * page_); }

  std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
  std::size_t page_;
  std::uint8_t* begin_ = nullptr;
  std::span<std::uint8_t> bytes_;
};

TYPED_TEST(EveryMessageTypeTest, NothingIsReadBeyondACut) {
  const Bytes whole = Encode(StampedSample<TypeParam>());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const BytesAtTheEnd cut(std::span<const std::uint8_t>(whole).first(size));
    EXPECT_FALSE(CheckLayout(MessageTraits<TypeParam>::kLayout,
                             TypeParam::getHash(), cut.bytes())
                     .ok())
        << size;
  }
}

// Layouts of this test's own, with any fingerprint.
constexpr std::int64_t kFingerprint = 5;
Bytes WithFingerprint(const Bytes& rest) {
  Bytes bytes(8 + rest.size());
  bytes[7] = kFingerprint;
  std::ranges::copy(rest, bytes.begin() + 8);
  return bytes;
}
bool Fits(std::string_view layout, const Bytes& rest) {
  return CheckLayout(layout, kFingerprint, WithFingerprint(rest)).ok();
}

TEST(CheckLayoutTest, TheFingerprintIsTheTypes) {
  EXPECT_TRUE(CheckLayout("b", kFingerprint, WithFingerprint({1})).ok());
  EXPECT_FALSE(CheckLayout("b", kFingerprint + 1, WithFingerprint({1})).ok());
}

TEST(CheckLayoutTest, NoByteIsLeftOver) {
  EXPECT_TRUE(Fits("b", {1}));
  EXPECT_FALSE(Fits("b", {1, 1}));
}

TEST(CheckLayoutTest, ACountBelowZeroIsRefusedEvenWithNothingToCount) {
  EXPECT_TRUE(Fits("N9", {0, 0, 0, 9}));
  EXPECT_FALSE(Fits("N9", {255, 255, 255, 255}));
  EXPECT_FALSE(Fits("N", {255, 255, 255, 255}));
}

TEST(CheckLayoutTest, AnArrayBeyondTheEndIsRefusedBeforeWhatFollowsIsRead) {
  const BytesAtTheEnd bytes(WithFingerprint({127, 255, 255, 255}));
  EXPECT_FALSE(CheckLayout("N l* s", kFingerprint, bytes.bytes()).ok());
}

TEST(CheckLayoutTest, ACountMayReachItsLimitAndNoMore) {
  EXPECT_TRUE(Fits("N2 b*", {0, 0, 0, 2, 9, 9}));
  EXPECT_FALSE(Fits("N2 b*", {0, 0, 0, 3, 9, 9, 9}));
  EXPECT_FALSE(Fits("N2 b*", {255, 255, 255, 255}));
}

TEST(CheckLayoutTest, ACountWithoutALimitIsBoundedByTheBytesAfterIt) {
  EXPECT_TRUE(Fits("N b*", {0, 0, 0, 3, 9, 9, 9}));
  EXPECT_FALSE(Fits("N b*", {0, 0, 0, 4, 9, 9, 9}));
  const Status checked = CheckLayout(
      "N b*", kFingerprint, WithFingerprint({127, 255, 255, 255, 9, 9}));
  ASSERT_FALSE(checked.ok());
  EXPECT_EQ(checked.error().message,
            "malformed message: count 2147483647, at most 2");
}

TEST(CheckLayoutTest, ACountHoldsForEachArrayAfterIt) {
  EXPECT_TRUE(Fits("N9 b*h*", {0, 0, 0, 2, 1, 1, 2, 2, 2, 2}));
  EXPECT_FALSE(Fits("N9 b*h*", {0, 0, 0, 2, 1, 1, 2, 2, 2}));
}

TEST(CheckLayoutTest, AStringEndsWithItsOnlyZero) {
  EXPECT_TRUE(Fits("s", {0, 0, 0, 1, 0}));
  EXPECT_TRUE(Fits("s", {0, 0, 0, 2, 'a', 0}));
  EXPECT_FALSE(Fits("s", {0, 0, 0, 0}));
  EXPECT_FALSE(Fits("s", {255, 255, 255, 251}));
  EXPECT_FALSE(Fits("s", {0, 0, 0, 2, 'a', 'b'}));
  EXPECT_FALSE(Fits("s", {0, 0, 0, 3, 0, 'b', 0}));
}

TEST(CheckLayoutTest, AStringMayReachItsLimitAndNoMore) {
  EXPECT_TRUE(Fits("s2 b", {0, 0, 0, 3, 'a', 'b', 0, 9}));
  EXPECT_FALSE(Fits("s2 b", {0, 0, 0, 4, 'a', 'b', 'c', 0, 9}));
  EXPECT_TRUE(Fits("N9 s2*", {0, 0, 0, 1, 0, 0, 0, 1, 0}));
}

TEST(DecodeTest, NamesAreBounded) {
  terra_msg::verdict_t verdict{};
  verdict.advisor.assign(kMaxNameBytes, 'x');
  EXPECT_TRUE(Decode<terra_msg::verdict_t>(Encode(verdict)).ok());
  verdict.advisor += 'x';
  EXPECT_THROW(Encode(verdict), std::logic_error);
}

// The gate answers to what is too much for it; nobody can to what does not
// decode.
TEST(DecodeTest, WhatIsSaidToTheGateIsBoundedByItsBytesAlone) {
  constexpr std::int32_t kMany = 7'000;
  terra_msg::advice_t advice{};
  advice.advisor.assign(1'000, 'x');
  advice.num_waypoints = kMany;
  advice.waypoint_x.resize(kMany);
  advice.waypoint_y.resize(kMany);
  EXPECT_TRUE(Decode<terra_msg::advice_t>(Encode(advice)).ok());
  terra_msg::baseline_t baseline{};
  baseline.planner.assign(1'000, 'x');
  baseline.num_waypoints = kMany;
  baseline.waypoint_x.resize(kMany);
  baseline.waypoint_y.resize(kMany);
  EXPECT_TRUE(Decode<terra_msg::baseline_t>(Encode(baseline)).ok());
}

TEST(DecodeTest, AProcessMayCountAsManyThingsAsItLikes) {
  constexpr std::int32_t kMany = 300;
  terra_msg::status_t status{};
  status.num_counters = kMany;
  status.counter_name.assign(kMany, "a counter");
  status.counter_value.assign(kMany, 7);
  EXPECT_TRUE(Decode<terra_msg::status_t>(Encode(status)).ok());
}

TEST(EncodeTest, MoreThanALayoutAllowsIsABugOfOurs) {
  terra_msg::map_request_t message{};
  message.num_missing = 4097;
  message.missing_tile.resize(4097);
  EXPECT_THROW(Encode(message), std::logic_error);
}

TEST(EncodeTest, TheLargestDeployedRouteFitsOneMessage) {
  terra_msg::deployed_t message{};
  message.source.assign(kMaxNameBytes, 'x');
  message.num_waypoints = static_cast<std::int32_t>(kMaxWaypoints);
  message.waypoint_x.resize(kMaxWaypoints);
  message.waypoint_y.resize(kMaxWaypoints);
  message.num_steps = static_cast<std::int32_t>(kMaxSteps);
  message.num_chain_bytes = static_cast<std::int32_t>(kMaxSteps / 2);
  message.chain.resize(static_cast<std::size_t>(kMaxSteps / 2));
  EXPECT_LE(Encode(message).size(), kMaxMessageBytes);
}

TEST(EncodeTest, TheLargestMapHeaderFitsOneMessage) {
  terra_msg::map_header_t message{};
  message.num_terrains = 256;
  message.terrain_id.resize(256);
  message.terrain_cost.resize(256);
  message.terrain_rgb.resize(256);
  message.terrain_name.resize(256, std::string(31, 'n'));
  message.num_tiles = 4096;
  message.tile_digest.resize(4096);
  EXPECT_LE(Encode(message).size(), kMaxMessageBytes);
}

TEST(CleanTextTest, ShowsWhereBytesWereThatNoTextMayHold) {
  EXPECT_EQ(CleanText(std::string_view("a\0b", 3), 10), "a\uFFFDb");
  EXPECT_EQ(CleanText("a\x1b[2J\x7f", 99), "a\uFFFD[2J\uFFFD");
  EXPECT_EQ(CleanText("caf\xe9!", 99), "caf\uFFFD!") << "Latin-1";
  EXPECT_EQ(CleanText("a\xe2\x82", 99), "a\uFFFD\uFFFD") << "a cut character";
  EXPECT_EQ(CleanText("\xc2\x9b", 99), "\uFFFD") << "a C1 control character";
}

TEST(CleanTextTest, LeavesTextsAsTheyAre) {
  for (const char* text :
       {"", "No.\n\t[(1, 2)]\r\n", "caf\u00e9 \u20ac \U0001F916"}) {
    EXPECT_EQ(CleanText(text, 99), text);
  }
}

TEST(CleanTextTest, ANameHasOneLine) {
  EXPECT_EQ(CleanLine("a\nSTOPPING=1\tb\r", 99), "a STOPPING=1 b ");
}

TEST(CleanTextTest, CutsBetweenCharacters) {
  EXPECT_EQ(CleanText("abc", 2), "ab");
  EXPECT_EQ(CleanText("a\xC3\xA9", 2), "a");
  EXPECT_EQ(CleanText("a\xC3\xA9", 3), "a\xC3\xA9");
}

}  // namespace
}  // namespace terra::bus
