#include "terrain/files/id_index.h"

#include <gtest/gtest.h>

namespace terra {
namespace {

TEST(IdIndex, FindsWhatIsThere) {
  const std::vector<std::string> ids = {"b", "", "ab", "a"};
  const IdIndex index = IndexOf(ids);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_EQ(index.Find(ids[i]), i);
    EXPECT_EQ(index[i], ids[i]);
  }
  for (const char* id : {"aa", "c", "A", "abc"}) {
    EXPECT_EQ(index.Find(id), std::nullopt) << id;
  }
  EXPECT_EQ(IndexOf(std::vector<std::string>{}).Find("a"), std::nullopt);
}

TEST(IdIndex, NamesTheFirstPlaceOfADouble) {
  EXPECT_EQ(IndexOf(std::vector<std::string>{"a", "b"}).FirstDouble(),
            std::nullopt);
  const std::vector<std::string> ids = {"z", "a", "b", "z", "a", "a"};
  const IdIndex index = IndexOf(ids);
  EXPECT_EQ(index.FirstDouble(), 3U);
  EXPECT_EQ(index.Find("a"), 1U);  // The first of them.
}

// What it chooses may not change: XXH3's own test vector.
TEST(HashOfId, IsTheSameEverywhere) {
  EXPECT_EQ(HashOfId(""), 0x2D06800538D394C2);
}

}  // namespace
}  // namespace terra
