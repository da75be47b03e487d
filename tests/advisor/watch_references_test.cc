#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "advisor/advisor_options.h"
#include "advisor/reference_pool.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra::advisor {
namespace {

using testing::ErrorMessage;
using ::testing::HasSubstr;
using testing::TempFolder;

// The pool that comes along, cut after so many pairs.
std::string PoolOf(int pairs) {
  // Once: packing the maps as small as they get takes seconds.
  static const std::string whole = ReferencePool::Builtin().Serialize();
  std::size_t end = 0;
  for (int line = 0; line <= pairs; ++line) end = whole.find('\n', end) + 1;
  return whole.substr(0, end);
}

TEST(WatchReferences, AChangedPoolIsReadBeforeTheNextCase) {
  const TempFolder folder;
  const std::string path = folder.Write("pool.jsonl", PoolOf(2));
  const auto latest = WatchReferences(path);
  ASSERT_TRUE(latest.ok()) << ErrorMessage(latest);
  const auto first = (*latest)();
  EXPECT_EQ(first->pairs().size(), 2U);
  EXPECT_EQ((*latest)(), first) << "nothing changed";
  folder.Write("pool.jsonl", PoolOf(3));
  EXPECT_EQ((*latest)()->pairs().size(), 3U);
  std::filesystem::remove(path);
  EXPECT_EQ((*latest)()->pairs().size(), 3U) << "the pool before stays";
  folder.Write("pool.jsonl", "nonsense");
  EXPECT_EQ((*latest)()->pairs().size(), 3U);
  folder.Write("pool.jsonl", PoolOf(4));
  EXPECT_EQ((*latest)()->pairs().size(), 4U);
}

TEST(WatchReferences, AMissingPoolIsNamedAtTheStart) {
  const TempFolder folder;
  EXPECT_THAT(ErrorMessage(WatchReferences(folder.Path("none.jsonl"))),
              HasSubstr("none.jsonl: no such reference pool"));
}

}  // namespace
}  // namespace terra::advisor
