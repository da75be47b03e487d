#include "advisor/answer_parser.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/route_text.h"
#include "tests/support/random_map.h"

namespace terra::advisor {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

struct GoodCase {
  std::string name;
  std::string text;
  std::string want;  ///< "yes", or the first route.
  AnswerForm form = AnswerForm::kTolerated;
};

class ReadableAnswerTest : public ::testing::TestWithParam<GoodCase> {};

TEST_P(ReadableAnswerTest, GivesWhatItMeans) {
  const GoodCase& tested = GetParam();
  const Answer answer = ParseAnswer(tested.text);
  EXPECT_EQ(FaultName(answer.fault), "none") << "at " << answer.position;
  EXPECT_EQ(answer.form, tested.form);
  if (tested.want == "yes") {
    EXPECT_EQ(answer.kind, AnswerKind::kRetain);
    EXPECT_THAT(answer.candidates, IsEmpty());
  } else {
    ASSERT_EQ(answer.kind, AnswerKind::kPropose);
    EXPECT_EQ(FormatRoute(answer.candidates.front().waypoints), tested.want);
  }
}

constexpr AnswerForm kExact = AnswerForm::kExact;
constexpr const char* kTwo = "[(1, 2), (3, 4)]";

INSTANTIATE_TEST_SUITE_P(
    Table, ReadableAnswerTest,
    ::testing::ValuesIn(std::vector<GoodCase>{
        {"Yes", "Yes", "yes", kExact},
        {"YesWithLineEnd", "\nYes \n", "yes", kExact},
        {"YesWithStop", "Yes.", "yes"},
        {"YesInLowerCase", "yes", "yes"},
        {"YesInBold", "**Yes.**", "yes"},
        {"YesInQuotes", "\"Yes\".", "yes"},
        {"YesInTypographicQuotes", "\u201cYES\u201d", "yes"},
        {"YesInFence", "```\nYes\n```", "yes"},
        {"YesInNamedFence", "```text\nYes\n```\n", "yes"},
        {"YesAmongNoBreakSpaces", "\u00a0Yes\u202f\u3000", "yes", kExact},
        {"YesAfterAByteOrderMark", "\ufeffYes\r\n", "yes", kExact},
        {"NoWithNoBreakSpaces",
         "No.\u00a0[(1,\u202f2),\u3000(3,\u2009 4)\u200b]\u2028", kTwo, kExact},
        {"NoInFenceAfterNoBreakSpace", "\u00a0```\nNo. [(1, 2), (3, 4)]\n```",
         kTwo},
        {"No", "No. [(1, 2), (3, 4)]", kTwo, kExact},
        {"NoWithoutSpaces", "No.[(1,2),(3,4)]", kTwo, kExact},
        {"NoOverLines", "No.\n[(1, 2),\n (3, 4)]\n", kTwo, kExact},
        {"Negative", "No. [(-1, 2), (3, 4)]", "[(-1, 2), (3, 4)]", kExact},
        {"NoWithoutStop", "No [(1, 2), (3, 4)]", kTwo},
        {"NoInBold", "**No.** [(1, 2), (3, 4)]", kTwo},
        {"NoInLowerCase", "no. [(1, 2), (3, 4)]", kTwo},
        {"ListAlone", "[(1, 2), (3, 4)]", kTwo},
        {"JsonBrackets", "No. [[1, 2], [3, 4]]", kTwo},
        {"RoundBrackets", "No. ((1, 2), (3, 4))", kTwo},
        {"Braces", "No. {{1, 2}, {3, 4}}", kTwo},
        {"MixedBrackets", "No. [[1, 2], (3, 4)]", kTwo},
        {"Fence", "No.\n```json\n[(1, 2), (3, 4)]\n```", kTwo},
        {"FenceAroundAll", "```\nNo. [(1, 2), (3, 4)]\n```", kTwo},
        {"WordsBefore", "No, this one is cheaper: [(1, 2), (3, 4)]", kTwo},
        {"WordsAfter", "No. [(1, 2), (3, 4)] It avoids the mud.", kTwo},
        {"BracketsInWords", "No. I see [two] ways (see it): [(1, 2), (3, 4)]",
         kTwo},
        {"BytesThatAreNoText", "\xff\xfe No. [(1, 2), (3, 4)] \x80", kTwo},
        {"PointsInWords", "From (9, 9) to (8, 8). No. [(1, 2), (3, 4)]", kTwo},
        {"ListBeforeTheNo", "Not [(9, 9), (8, 8)] but: No. [(1, 2), (3, 4)]",
         kTwo},
        {"NoCommaBetween", "No. [(1, 2) (3, 4)]", kTwo},
        {"CommaAtTheEnd", "No. [(1, 2), (3, 4),]", kTwo},
        {"LeadingZeros", "No. [(01, 2), (3, 004)]", kTwo},
        {"NoOuterBrackets", "No. (1, 2), (3, 4)", kTwo},
        {"OneWaypoint", "No. [(1, 2)]", "[(1, 2)]", kExact},
        {"NineDigits", "No. [(123456789, 2), (3, 4)]",
         "[(123456789, 2), (3, 4)]", kExact},
        {"SecondListNotAskedFor", "No. [(1, 2), (3, 4)]; [(5, 6)]", kTwo},
    }),
    [](const auto& tested) {
      return tested.param.name;
    });

struct BadCase {
  std::string name;
  std::string text;
  AnswerFault fault;
  std::size_t position;
};

class UnreadableAnswerTest : public ::testing::TestWithParam<BadCase> {};

TEST_P(UnreadableAnswerTest, IsAnAttemptWithReasonAndPosition) {
  const BadCase& tested = GetParam();
  const Answer answer = ParseAnswer(tested.text);
  EXPECT_EQ(answer.kind, AnswerKind::kMalformed);
  EXPECT_EQ(FaultName(answer.fault), FaultName(tested.fault));
  EXPECT_EQ(answer.position, tested.position);
  EXPECT_THAT(answer.candidates, ::testing::Each(::testing::Field(
                                     &AnswerCandidate::waypoints, IsEmpty())));
}

INSTANTIATE_TEST_SUITE_P(
    Table, UnreadableAnswerTest,
    ::testing::ValuesIn(std::vector<BadCase>{
        {"Nothing", "", AnswerFault::kEmpty, 0},
        {"OnlySpace", " \n\t", AnswerFault::kEmpty, 0},
        {"YesBecause", "Yes, because it is short.", AnswerFault::kYesNotAlone,
         0},
        {"YesWithList", "Yes. [(1, 2), (3, 4)]", AnswerFault::kYesNotAlone, 0},
        {"YesAfterList", "No. [(1, 2), (3, 4)] Yes", AnswerFault::kYesNotAlone,
         21},
        {"TwoStops", "Yes..", AnswerFault::kYesNotAlone, 0},
        {"LabelledYes", "Answer: Yes", AnswerFault::kYesNotAlone, 8},
        {"NoAlone", "No.", AnswerFault::kNoList, 3},
        {"OnlyWords", "I cannot see the map.", AnswerFault::kNoList, 21},
        {"OnePointInWords", "Go by (3, 4) then.", AnswerFault::kNoList, 18},
        {"FlatNumbers", "No. [1, 2, 3, 4]", AnswerFault::kNoList, 16},
        {"EmptyList", "No. []", AnswerFault::kEmptyList, 4},
        {"Fraction", "No. [(1.5, 2), (3, 4)]", AnswerFault::kNotAnInteger, 7},
        {"FractionOfZero", "No. [(1, 2.0), (3, 4)]", AnswerFault::kNotAnInteger,
         10},
        {"Exponent", "No. [(1e2, 2), (3, 4)]", AnswerFault::kNotAnInteger, 7},
        {"PlusSign", "No. [(+1, 2), (3, 4)]", AnswerFault::kNotAnInteger, 6},
        {"Template", "No. [(x1, y1), (x2, y2)]", AnswerFault::kNotAnInteger, 6},
        {"TenDigits", "No. [(1234567890, 2)]", AnswerFault::kNumberTooLong, 6},
        {"OneCoordinate", "No. [(1), (3, 4)]", AnswerFault::kNotAPair, 7},
        {"ThreeCoordinates", "No. [(1, 2, 3), (3, 4)]", AnswerFault::kNotAPair,
         10},
        {"WrongCloser", "No. [(1, 2], (3, 4)]", AnswerFault::kNotAPair, 10},
        {"Ellipsis", "No. [(1, 2), ..., (3, 4)]", AnswerFault::kUnexpectedText,
         13},
        {"Cut", "No. [(1, 2), (3, 4)", AnswerFault::kUnclosedList, 19},
        {"CutInANumber", "No. [(1, 2), (3", AnswerFault::kUnclosedList, 15},
        {"CutRow", "No. (1, 2), (3, 4), (5", AnswerFault::kUnclosedList, 22},
        {"ExactListAfterABadOne", "No. [(1.5, 2)]; [(1, 2), (3, 4)]",
         AnswerFault::kNotAnInteger, 7},
    }),
    [](const auto& tested) {
      return tested.param.name;
    });

TEST(AnswerParserTest, ReadsCandidatesInOrderUpToTheNumberAskedFor) {
  AnswerRules rules;
  rules.max_candidates = 3;
  for (const std::string between : {"; ", "\n", ";\n"}) {
    const Answer answer = ParseAnswer(
        "No. [(1, 2)]" + between + "[(3, 4)]" + between + "[(5, 6)]", rules);
    ASSERT_THAT(answer.candidates, SizeIs(3));
    EXPECT_THAT(answer.candidates[2].waypoints, ElementsAre(Cell{5, 6}));
    EXPECT_EQ(answer.form, AnswerForm::kExact);
  }
  rules.max_candidates = 2;
  const Answer more = ParseAnswer("No. [(1, 2)]; [(3, 4)]; [(5, 6)]", rules);
  EXPECT_THAT(more.candidates, SizeIs(2));
  EXPECT_EQ(more.form, AnswerForm::kTolerated);
}

TEST(AnswerParserTest, ALaterCandidateFailsAlone) {
  AnswerRules rules;
  rules.max_candidates = 3;
  const Answer answer =
      ParseAnswer("No. [(1, 2)]; [(3, 4.5)]; [(5, 6)]", rules);
  ASSERT_THAT(answer.candidates, SizeIs(3));
  EXPECT_EQ(answer.candidates[1].fault, AnswerFault::kNotAnInteger);
  EXPECT_EQ(answer.candidates[1].position, 20u);
  EXPECT_THAT(answer.candidates[2].waypoints, ElementsAre(Cell{5, 6}));
}

TEST(AnswerParserTest, ARouteAloneIsTheExactFormWhereOneWasAskedFor) {
  AnswerRules rules;
  rules.style = AnswerStyle::kRoute;
  EXPECT_EQ(ParseAnswer("[(1, 2), (3, 4)]", rules).form, AnswerForm::kExact);
  EXPECT_EQ(ParseAnswer("No. [(1, 2), (3, 4)]", rules).form,
            AnswerForm::kTolerated);
  EXPECT_EQ(ParseAnswer("Yes", rules).kind, AnswerKind::kMalformed);
}

TEST(AnswerParserTest, BoundsAreHeldOnBothSides) {
  AnswerRules rules;
  rules.max_waypoints = 2;
  EXPECT_EQ(ParseAnswer("No. [(1, 2), (3, 4)]", rules).kind,
            AnswerKind::kPropose);
  EXPECT_EQ(ParseAnswer("No. [(1, 2), (3, 4), (5, 6)]", rules).fault,
            AnswerFault::kTooManyWaypoints);
  EXPECT_EQ(ParseAnswer("No. (1, 2), (3, 4), (5, 6)", rules).fault,
            AnswerFault::kTooManyWaypoints);
  rules.max_bytes = 3;
  EXPECT_EQ(ParseAnswer("Yes", rules).kind, AnswerKind::kRetain);
  EXPECT_EQ(ParseAnswer("Yes.", rules).fault, AnswerFault::kTooLong);
}

TEST(AnswerParserTest, EveryWrittenRouteIsReadBack) {
  testing::Random random(4);
  for (int round = 0; round < 200; ++round) {
    Route route;
    for (int i = random.Int(1, 40); i > 0; --i) {
      route.push_back({random.Int(-999, 9999), random.Int(-999, 9999)});
    }
    const Answer answer = ParseAnswer("No. " + FormatRoute(route));
    ASSERT_EQ(answer.kind, AnswerKind::kPropose);
    EXPECT_EQ(answer.candidates.front().waypoints, route);
    EXPECT_EQ(answer.form, AnswerForm::kExact);
  }
}

// Any bytes: no crash, positions inside the text, and whatever is read keeps
// the promises of the header.
TEST(AnswerParserTest, AnyBytesGiveAWellFormedResult) {
  const std::vector<std::string> pieces = {
      "Yes", "No. ", "no",  "[", "]",    "(", ")",      "{",
      "}",   ",",    ";",   "1", "2.5",  "-", " ",      "\n",
      "*",   "`",    "```", "x", "\xff", ".", "(1, 2)", std::string(1, '\0')};
  testing::Random random(5);
  AnswerRules rules;
  for (int round = 0; round < 20'000; ++round) {
    std::string text;
    for (int i = random.Int(0, 24); i > 0; --i) {
      text += pieces[static_cast<std::size_t>(
          random.Int(0, static_cast<int>(pieces.size()) - 1))];
    }
    rules.max_candidates = random.Int(1, 3);
    rules.max_waypoints = static_cast<std::size_t>(random.Int(1, 5));
    const Answer answer = ParseAnswer(text, rules);
    EXPECT_LE(answer.position, text.size());
    EXPECT_EQ(answer.fault == AnswerFault::kNone,
              answer.kind != AnswerKind::kMalformed);
    EXPECT_LE(answer.candidates.size(),
              static_cast<std::size_t>(rules.max_candidates));
    if (answer.kind == AnswerKind::kPropose) {
      ASSERT_THAT(answer.candidates, ::testing::Not(IsEmpty()));
      EXPECT_EQ(answer.candidates.front().fault, AnswerFault::kNone);
    }
    for (const AnswerCandidate& candidate : answer.candidates) {
      EXPECT_LE(candidate.waypoints.size(), rules.max_waypoints);
      EXPECT_LE(candidate.position, text.size());
    }
  }
}

TEST(AnswerParserTest, EverySpaceOfUnicodeIsWhiteSpace) {
  for (const char* space :
       {"\u0085", "\u00a0", "\u1680", "\u2000", "\u2001", "\u2002",
        "\u2003", "\u2004", "\u2005", "\u2006", "\u2007", "\u2008",
        "\u2009", "\u200a", "\u200b", "\u2028", "\u2029", "\u202f",
        "\u205f", "\u2060", "\u3000", "\ufeff"}) {
    const std::string s = space;
    EXPECT_EQ(ParseAnswer(s + "Yes" + s).kind, AnswerKind::kRetain) << s;
    EXPECT_EQ(
        ParseAnswer("No." + s + "[(1," + s + "2)," + s + "(3, 4)" + s + "]")
            .kind,
        AnswerKind::kPropose)
        << s;
    EXPECT_EQ(ParseAnswer(s + s).fault, AnswerFault::kEmpty) << s;
    EXPECT_TRUE(IsBlankAnswer("\n" + s)) << s;
  }
}

TEST(AnswerParserTest, AFaultBehindAWideSpaceIsAtItsByte) {
  const Answer answer = ParseAnswer("No.\u3000[(1, x)]");
  EXPECT_EQ(answer.fault, AnswerFault::kNotAnInteger);
  EXPECT_EQ(answer.position, 11u);
}

TEST(AnswerParserTest, AZeroByteIsNoSpace) {
  EXPECT_EQ(ParseAnswer(std::string_view("Yes\0", 4)).kind,
            AnswerKind::kMalformed);
  EXPECT_EQ(ParseAnswer(std::string_view("No. [(1\0, 2), (3, 4)]", 21)).kind,
            AnswerKind::kMalformed);
}

}  // namespace
}  // namespace terra::advisor
