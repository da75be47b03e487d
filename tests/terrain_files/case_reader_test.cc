#include "terrain/files/case_reader.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

using testing::ErrorMessage;
using ::testing::HasSubstr;
using testing::TempFolder;

constexpr char kHeader[] = "case_id,map,start_x,start_y,goal_x,goal_y,group\n";

std::string Line(const std::string& id) {
  return id + ",m.png,0,0,1,1,g\n";
}

TEST(CaseReader, ReadsCaseAfterCaseAndNamesTheLineOfAFault) {
  const TempFolder folder;
  folder.Write("cases.csv", kHeader + Line("a") + "\n" + Line("\"b,c\"") +
                                "d,m.png,0,0,x,1,g\n");
  auto reader = CaseReader::Open(folder.Path(""));
  ASSERT_TRUE(reader.ok()) << ErrorMessage(reader);
  EXPECT_EQ(reader->Next().value()->case_id, "a");
  EXPECT_EQ(reader->line(), 2);
  EXPECT_EQ(reader->Next().value()->case_id, "b,c");
  EXPECT_EQ(reader->line(), 4);
  EXPECT_THAT(ErrorMessage(reader->Next()), HasSubstr("cases.csv:5: goal_x"));
}

// Results are kept in a line for each case.
TEST(CaseReader, AnIdOfTwoLinesIsRefused) {
  const TempFolder folder;
  folder.Write("cases.csv", kHeader + Line("a") + Line("\"b\nc\""));
  auto reader = CaseReader::Open(folder.Path(""));
  ASSERT_TRUE(reader.ok()) << ErrorMessage(reader);
  ASSERT_TRUE(reader->Next().ok());
  EXPECT_THAT(ErrorMessage(reader->Next()),
              HasSubstr("cases.csv:3: a case_id with a line break"));
}

// Few ids at once make many parts.
class CheckCasesInParts : public ::testing::TestWithParam<std::size_t> {};

TEST_P(CheckCasesInParts, DifferentIdsAreUsedOnceEach) {
  const TempFolder folder;
  std::string text = kHeader;
  std::vector<std::string> ids;
  for (int i = 0; i < 200; ++i) {
    ids.push_back("case_" + std::to_string(i));
    text += Line(ids.back());
  }
  folder.Write("cases.csv", text);
  std::vector<std::string> used;
  const Status checked = CheckCases(
      folder.Path(""),
      [&](const DatasetCase& c) {
        used.push_back(c.case_id);
      },
      GetParam());
  ASSERT_TRUE(checked.ok()) << ErrorMessage(checked);
  EXPECT_EQ(used, ids);
}

TEST_P(CheckCasesInParts, AnIdThatComesTwiceIsFoundWhereverItStands) {
  constexpr int kCases = 60;
  for (int first = 0; first < kCases; first += 7) {
    for (int second = first + 1; second < kCases; second += 5) {
      const TempFolder folder;
      std::string text = kHeader;
      for (int i = 0; i < kCases; ++i) {
        text += Line("c" + std::to_string(i == second ? first : i));
      }
      folder.Write("cases.csv", text);
      EXPECT_THAT(
          ErrorMessage(CheckCases(
              folder.Path(""), [](const DatasetCase&) {}, GetParam())),
          HasSubstr("cases.csv:" + std::to_string(second + 2) + ": case_id 'c" +
                    std::to_string(first) + "' comes twice"));
    }
  }
}

TEST_P(CheckCasesInParts, OneIdAgainAndAgainIsFound) {
  const TempFolder folder;
  std::string text = kHeader;
  for (int i = 0; i < 100; ++i) text += Line("a");
  folder.Write("cases.csv", text);
  EXPECT_THAT(ErrorMessage(CheckCases(
                  folder.Path(""), [](const DatasetCase&) {}, GetParam())),
              HasSubstr("cases.csv:3: case_id 'a' comes twice"));
}

INSTANTIATE_TEST_SUITE_P(AtOnce, CheckCasesInParts,
                         ::testing::Values(1, 2, 8, 50, 1000));

}  // namespace
}  // namespace terra
