#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmark/case_result.h"
#include "benchmark/results_file.h"
#include "benchmark/results_reader.h"
#include "terrain/files/whole_file.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

using terra::testing::ErrorMessage;
using terra::testing::TempFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<std::string> kIds = {"a", "b", "c"};

const CaseIds kAbc = [](const auto& use) -> Status {
  for (const std::string& id : kIds) {
    const Status used = use(id);
    if (!used.ok()) return used;
  }
  return Done{};
};

// Adds a row of one of these cases.
Status Append(ResultsFile& file, const CaseResult& result) {
  const auto place = std::find(kIds.begin(), kIds.end(), result.case_id);
  return file.Append(static_cast<std::size_t>(place - kIds.begin()), result);
}

CaseResult FullResult() {
  CaseResult r;
  r.case_id = "hard_0003";
  r.group = "hard";
  r.sequence = "trail-3";
  r.map_id = -8123456789012345678;
  r.repeat = 2;
  r.kind = AttemptKind::kPropose;
  r.code = verifier::Code::kNotCheaper;
  r.form = AnswerStyle::kTolerated;
  r.baseline_cost = 100.1;
  r.oracle_cost = 80.0 / 3;
  r.candidate_cost = 123;
  r.final_cost = 100.1;
  r.candidate_route = {{-1, 2}, {3, 4}};
  r.final_route = {{0, 2}, {3, 4}};
  r.t_prep = 0.25;
  r.t_llm = 17.5;
  r.t_det = 1e-5;
  r.tries = 2;
  r.tokens_in = 4000;
  r.tokens_out = 120;
  r.spend = 0.0123;
  r.request_hash = "00ff";
  return r;
}

CaseResult Row(const std::string& id,
               AttemptKind kind = AttemptKind::kPropose) {
  CaseResult r;
  r.case_id = id;
  r.kind = kind;
  return r;
}

std::vector<std::string> IdsIn(const std::string& path) {
  std::vector<std::string> ids;
  const Status read = ReadResults(path, [&](const CaseResult& r) {
    ids.push_back(r.case_id);
  });
  EXPECT_TRUE(read.ok()) << ErrorMessage(read);
  return ids;
}

std::unique_ptr<ResultsFile> OpenAbc(const std::string& path) {
  auto file = ResultsFile::Open(path, kAbc, 1);
  EXPECT_TRUE(file.ok()) << ErrorMessage(file);
  return *std::move(file);
}

TEST(ResultLine, IsReadBackWhole) {
  const TempFolder folder;
  const std::string path =
      folder.Write("r.csv", ResultsHeader() + ResultLine(FullResult()));
  std::vector<CaseResult> read;
  ASSERT_TRUE(ReadResults(path, [&](CaseResult r) {
                read.push_back(std::move(r));
              }).ok());
  EXPECT_THAT(read, ElementsAre(FullResult()));
}

TEST(ResultLine, HasTheCandidatesWhereItIsToHaveThem) {
  const TempFolder folder;
  constexpr auto kColumns = ResultColumns::kWithCandidates;
  CaseResult result = FullResult();
  result.candidates = 5;
  result.candidates_lower = 2;
  result.candidates_invalid = 1;
  const std::string path = folder.Write(
      "r.csv", ResultsHeader(kColumns) + ResultLine(result, kColumns));
  std::vector<CaseResult> read;
  ASSERT_TRUE(ReadResults(path, [&](CaseResult r) {
                read.push_back(std::move(r));
              }).ok());
  EXPECT_THAT(read, ElementsAre(result));
}

TEST(ReadResults, NamesLineAndColumnOfAFault) {
  const TempFolder folder;
  std::string bad = ResultLine(FullResult());
  bad.replace(bad.find("not_cheaper"), 11, "cheaperish!");
  const std::string path =
      folder.Write("r.csv", ResultsHeader() + ResultLine(FullResult()) + bad);
  EXPECT_THAT(ErrorMessage(ReadResults(path, [](const CaseResult&) {})),
              HasSubstr("r.csv:3: 'cheaperish!' is no code"));
}

TEST(ReadResults, RefusesAnotherFile) {
  const TempFolder folder;
  const std::string path = folder.Write("r.csv", "case_id,route\n");
  EXPECT_THAT(ErrorMessage(ReadResults(path, [](const CaseResult&) {})),
              HasSubstr("not the header"));
}

TEST(ResultsFile, FinishedHasTheRowsInOrderOfTheCases) {
  const TempFolder folder;
  const std::string path = folder.Path("r.csv");
  const auto file = OpenAbc(path);
  for (const char* id : {"c", "a", "b"}) {
    ASSERT_TRUE(Append(*file, Row(id)).ok());
  }
  ASSERT_TRUE(file->Finish().ok());
  EXPECT_THAT(IdsIn(path), ElementsAre("a", "b", "c"));
}

TEST(ResultsFile, ReopenedKnowsWhatIsDone) {
  const TempFolder folder;
  const std::string path = folder.Path("r.csv");
  ASSERT_TRUE(Append(*OpenAbc(path), Row("b")).ok());
  const auto file = OpenAbc(path);
  EXPECT_FALSE(file->IsDone(0, 0));
  EXPECT_TRUE(file->IsDone(1, 0));
  EXPECT_EQ(file->num_done(), 1);
}

TEST(ResultsFile, ATornLastLineIsCutOffAtEveryByte) {
  const TempFolder folder;
  const std::string whole = ResultsHeader() + ResultLine(Row("a"));
  const std::string last = ResultLine(Row("b"));
  for (std::size_t length = 0; length < last.size(); ++length) {
    const std::string path =
        folder.Write("r.csv", whole + last.substr(0, length));
    const auto file = OpenAbc(path);
    ASSERT_EQ(file->num_done(), 1) << length;
    ASSERT_TRUE(Append(*file, Row("b")).ok());
    ASSERT_TRUE(Append(*file, Row("c")).ok());
    ASSERT_TRUE(file->Finish().ok());
    ASSERT_THAT(IdsIn(path), ElementsAre("a", "b", "c")) << length;
  }
}

TEST(ResultsFile, ATornHeaderStartsAnew) {
  const TempFolder folder;
  const std::string path = folder.Write("r.csv", ResultsHeader().substr(0, 20));
  EXPECT_EQ(OpenAbc(path)->num_done(), 0);
}

TEST(ResultsFile, CasesWithoutAnAnswerAreAskedAgain) {
  const TempFolder folder;
  const std::string path = folder.Path("r.csv");
  {
    const auto file = OpenAbc(path);
    ASSERT_TRUE(Append(*file, Row("a", AttemptKind::kNoAnswer)).ok());
    ASSERT_TRUE(Append(*file, Row("b")).ok());
    ASSERT_TRUE(file->Finish().ok());
    EXPECT_THAT(IdsIn(path), ElementsAre("a", "b"));
  }
  const auto file = OpenAbc(path);
  EXPECT_FALSE(file->IsDone(0, 0));
  ASSERT_TRUE(Append(*file, Row("a")).ok());
  ASSERT_TRUE(file->Finish().ok());
  EXPECT_THAT(IdsIn(path), ElementsAre("a", "b"));
}

TEST(ResultsFile, RowsOfSeveralStartsArePutIntoOrder) {
  // What was asked again stands behind the others when it was killed then.
  const TempFolder folder;
  const std::string path = folder.Path("r.csv");
  std::string rows = ResultsHeader();
  for (const char* id : {"c", "b", "a"}) rows += ResultLine(Row(id));
  folder.Write("r.csv", rows);
  EXPECT_EQ(OpenAbc(path)->num_done(), 3);
  EXPECT_THAT(IdsIn(path), ElementsAre("a", "b", "c"));
}

TEST(ResultsFile, RepeatsStandTogetherWhicheverWasAskedLast) {
  const TempFolder folder;
  const std::string path = folder.Path("r.csv");
  std::vector<CaseResult> wanted;
  for (const char* id : {"a", "b", "c"}) {
    for (const int repeat : {0, 1, 2}) {
      wanted.push_back(Row(id));
      wanted.back().repeat = repeat;
    }
  }
  std::string rows = ResultsHeader();
  for (const int i : {0, 2, 3, 4, 8, /* second start */ 1, 6, 7}) {
    rows += ResultLine(wanted[static_cast<std::size_t>(i)]);
  }
  folder.Write("r.csv", rows);
  auto file = ResultsFile::Open(path, kAbc, 3);
  ASSERT_TRUE(file.ok()) << ErrorMessage(file);
  EXPECT_FALSE((*file)->IsDone(1, 2));
  EXPECT_TRUE((*file)->IsDone(2, 2));
  ASSERT_TRUE(Append(**file, wanted[5]).ok());
  ASSERT_TRUE((*file)->Finish().ok());
  std::vector<CaseResult> read;
  ASSERT_TRUE(ReadResults(path, [&](CaseResult r) {
                read.push_back(std::move(r));
              }).ok());
  EXPECT_EQ(read, wanted);
}

TEST(ResultsFile, RefusesRowsInNoOrder) {
  const TempFolder folder;
  std::string rows = ResultsHeader();
  for (std::size_t i = 0; i <= kMaxSortedParts; ++i) {
    rows += ResultLine(Row("b"));
  }
  const std::string path = folder.Write("r.csv", rows);
  EXPECT_THAT(ErrorMessage(ResultsFile::Open(path, kAbc, 1)),
              HasSubstr("in no order of the cases"));
}

TEST(ResultsFile, IsLockedAgainstASecondWriter) {
  const TempFolder folder;
  const std::string path = folder.Path("r.csv");
  const auto file = OpenAbc(path);
  EXPECT_THAT(ErrorMessage(ResultsFile::Open(path, kAbc, 1)),
              HasSubstr("another process"));
}

TEST(ResultsFile, RefusesRowsOfAnotherRun) {
  const TempFolder folder;
  const std::string path =
      folder.Write("r.csv", ResultsHeader() + ResultLine(Row("z")));
  EXPECT_THAT(ErrorMessage(ResultsFile::Open(path, kAbc, 1)),
              HasSubstr("'z' repeat 0 is not of this run"));
}

}  // namespace
}  // namespace terra::benchmark
