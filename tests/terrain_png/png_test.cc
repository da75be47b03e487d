#include "terrain/png/png.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_message.h"
#include "tests/support/hand_made_png.h"
#include "tests/support/random_map.h"

namespace terra {
namespace {

using ::testing::AllOf;
using testing::BigEndian;
using testing::Chunk;
using ::testing::ElementsAre;
using testing::ErrorMessage;
using testing::HandMade;
using ::testing::HasSubstr;
using testing::Random;

constexpr int kMaxSide = 8'192;

Result<Pixels> Decode(std::string_view bytes) {
  return DecodePng(bytes, kMaxSide, "m.png");
}

Pixels RandomPixels(Random& random, int width, int height, PixelOrder order) {
  Pixels pixels{width, height, order, {}};
  pixels.bytes.resize(static_cast<std::size_t>(width * height) *
                      static_cast<std::size_t>(BytesPerPixel(order)));
  // Long runs and noise.
  const int most = random.Int(0, 1) == 0 ? 1 : 255;
  for (std::uint8_t& byte : pixels.bytes) {
    byte = static_cast<std::uint8_t>(random.Int(0, most));
  }
  return pixels;
}

TEST(Png, PixelsSurviveWritingAndReading) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Pixels pixels =
        RandomPixels(random, random.Int(1, 70), random.Int(1, 40),
                     i % 2 == 0 ? PixelOrder::kGrey : PixelOrder::kRgb);
    for (const PngEffort effort : {PngEffort::kFast, PngEffort::kSmall}) {
      const auto read = Decode(EncodePng(pixels.view(), effort));
      ASSERT_TRUE(read.ok()) << ErrorMessage(read);
      ASSERT_EQ(read->width, pixels.width);
      ASSERT_EQ(read->height, pixels.height);
      ASSERT_EQ(read->order, pixels.order);
      ASSERT_EQ(read->bytes, pixels.bytes);
    }
  }
}

TEST(Png, BlueFirstIsWrittenRedFirst) {
  const std::uint8_t bgr[] = {1, 2, 3, 4, 5, 6};
  const auto read = Decode(EncodePng({bgr, 2, 1, PixelOrder::kBgr}));
  ASSERT_TRUE(read.ok()) << ErrorMessage(read);
  EXPECT_EQ(read->order, PixelOrder::kRgb);
  EXPECT_THAT(read->bytes, ElementsAre(3, 2, 1, 6, 5, 4));
}

TEST(Png, AHandMadeOneIsRead) {
  const auto read = Decode(HandMade{}.Bytes());
  ASSERT_TRUE(read.ok()) << ErrorMessage(read);
  EXPECT_THAT(read->bytes, ElementsAre(7));
}

TEST(Png, InterlacedRowsAreRead) {
  HandMade png{.width = 2, .height = 2, .interlace = 1};
  // Pixel (0, 0); then (1, 0); then the second row.
  png.rows = std::string("\0\1\0\2\0\3\4", 7);
  const auto read = Decode(png.Bytes());
  ASSERT_TRUE(read.ok()) << ErrorMessage(read);
  EXPECT_THAT(read->bytes, ElementsAre(1, 2, 3, 4));
}

TEST(Png, GammaAndProfilesChangeNoValue) {
  HandMade png;
  png.chunks = Chunk("gAMA", BigEndian(20'000)) +
               Chunk("iCCP", std::string("no profile\0\0", 12)) +
               Chunk("zTXt", "no text") + Chunk("teSt", "of our own");
  const auto read = Decode(png.Bytes());
  ASSERT_TRUE(read.ok()) << ErrorMessage(read);
  EXPECT_THAT(read->bytes, ElementsAre(7));
}

TEST(Png, WhatWouldBeConvertedIsRefused) {
  const auto refusal = [](const HandMade& png) {
    return ErrorMessage(Decode(png.Bytes()));
  };
  const std::string palette = Chunk("PLTE", "\1\2\3");
  EXPECT_THAT(refusal({.color_type = 3, .chunks = palette}),
              HasSubstr("m.png: this PNG has a palette; save it as"));
  EXPECT_THAT(refusal({.depth = 16}), HasSubstr("16 bits per channel"));
  EXPECT_THAT(refusal({.depth = 1}), HasSubstr("1 bits per channel"));
  EXPECT_THAT(refusal({.color_type = 4}), HasSubstr("an alpha channel"));
  EXPECT_THAT(refusal({.color_type = 6}), HasSubstr("an alpha channel"));
  EXPECT_THAT(refusal({.chunks = Chunk("tRNS", std::string(2, '\0'))}),
              HasSubstr("a transparent colour"));
}

TEST(Png, ATruncatedOneIsRefusedAtEveryLength) {
  Random random(2);
  const Pixels pixels = RandomPixels(random, 30, 20, PixelOrder::kRgb);
  const std::string whole = EncodePng(pixels.view());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    ASSERT_THAT(ErrorMessage(Decode(std::string_view(whole).substr(0, length))),
                HasSubstr("truncated"))
        << length << " bytes";
  }
}

TEST(Png, ADamagedByteNeverGivesOtherPixels) {
  Random random(3);
  const Pixels pixels = RandomPixels(random, 16, 16, PixelOrder::kRgb);
  const std::string whole = EncodePng(pixels.view());
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const int bit : {0, 4, 7}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ 1 << bit);
      const auto read = Decode(damaged);
      if (!read.ok()) continue;
      ASSERT_EQ(read->bytes, pixels.bytes) << "byte " << at;
    }
  }
}

TEST(Png, MoreThanTheMostASideIsRefused) {
  EXPECT_THAT(ErrorMessage(Decode(HandMade{.width = 8'193}.Bytes())),
              AllOf(HasSubstr("8193 x 1 pixels"), HasSubstr("1 to 8192")));
  EXPECT_THAT(ErrorMessage(Decode(HandMade{.height = 8'193}.Bytes())),
              HasSubstr("1 x 8193 pixels"));
}

TEST(Png, AFewBytesTakeNoMemoryForMillionsOfPixels) {
  const HandMade png{.width = 8'192, .height = 8'192, .color_type = 2};
  EXPECT_THAT(ErrorMessage(Decode(png.Bytes())), HasSubstr("truncated"));
}

TEST(Png, EvenTheBestCompressionIsTaken) {
  const Pixels white{4'096, 4'096, PixelOrder::kGrey,
                     std::vector<std::uint8_t>(4'096 * 4'096, 255)};
  const std::string png = EncodePng(white.view(), PngEffort::kSmall);
  const auto read = Decode(png);
  ASSERT_TRUE(read.ok()) << png.size() << " bytes: " << ErrorMessage(read);
  EXPECT_EQ(read->bytes, white.bytes);
}

}  // namespace
}  // namespace terra
