#include "terrain/utf8.h"

#include <string>

#include <gtest/gtest.h>

namespace terra {
namespace {

TEST(Utf8Test, ReadsCharactersOfEveryLength) {
  struct Case {
    std::string text;
    char32_t code;
  };
  for (const Case& tested :
       {Case{"a", 'a'}, Case{std::string(1, '\0'), 0}, Case{"\x7f", 0x7F},
        Case{"\xc2\x80", 0x80}, Case{"\xdf\xbf", 0x7FF},
        Case{"\xe0\xa0\x80", 0x800}, Case{"\xed\x9f\xbf", 0xD7FF},
        Case{"\xee\x80\x80", 0xE000}, Case{"\xef\xbf\xbf", 0xFFFF},
        Case{"\xf0\x90\x80\x80", 0x10000},
        Case{"\xf4\x8f\xbf\xbf", 0x10FFFF}}) {
    const Utf8Character read = ReadUtf8(tested.text, 0);
    EXPECT_TRUE(read.valid) << testing::PrintToString(tested.text);
    EXPECT_EQ(read.code, tested.code);
    EXPECT_EQ(read.bytes, tested.text.size());
    EXPECT_TRUE(IsUtf8(tested.text));
  }
}

// RFC 3629, section 3: over-long forms, surrogates, beyond U+10FFFF, cut ones.
TEST(Utf8Test, RefusesWhatIsNone) {
  for (const std::string text :
       {"\x80", "\xbf", "\xc0\xaf", "\xc1\xbf", "\xc2", "\xc2\x41",
        "\xe0\x9f\xbf", "\xe2\x82", "\xed\xa0\x80", "\xed\xbf\xbf",
        "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xfe",
        "\xff", "\xe9t\xe9"}) {
    const Utf8Character read = ReadUtf8(text, 0);
    EXPECT_FALSE(read.valid) << testing::PrintToString(text);
    EXPECT_EQ(read.bytes, 1u);
    EXPECT_FALSE(IsUtf8("a" + text));
  }
}

}  // namespace
}  // namespace terra
