#include "terrain/files/csv.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_message.h"
#include "tests/support/random_map.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

using ::testing::ElementsAre;
using testing::ErrorMessage;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Csv, FieldsMayBeQuoted) {
  const auto table = ParseCsv("a,b\n\"x, y\",\"he said \"\"no\"\"\"\n", "t");
  ASSERT_TRUE(table.ok()) << ErrorMessage(table);
  EXPECT_THAT(table->rows[0].fields, ElementsAre("x, y", "he said \"no\""));
}

TEST(Csv, LineEndsByteOrderMarkAndEmptyLinesDoNotMatter) {
  const auto table = ParseCsv(
      "\xEF\xBB\xBF"
      "a,b\r\n\r\n1,2\r\n\n3,",
      "t");
  ASSERT_TRUE(table.ok()) << ErrorMessage(table);
  EXPECT_EQ(table->Column("a"), 0);
  EXPECT_EQ(table->Column("c"), -1);
  ASSERT_EQ(table->rows.size(), 2U);
  EXPECT_EQ(table->rows[1].line, 5);
  EXPECT_THAT(table->rows[1].fields, ElementsAre("3", ""));
}

TEST(Csv, BlanksAroundFieldsDoNotCount) {
  const auto table = ParseCsv("id, name ,\tcost\n 1 , a b ,\" 2, 3 \" \n", "t");
  ASSERT_TRUE(table.ok()) << ErrorMessage(table);
  EXPECT_THAT(table->header, ElementsAre("id", "name", "cost"));
  EXPECT_THAT(table->rows[0].fields, ElementsAre("1", "a b", " 2, 3 "));
}

TEST(Csv, CommentLinesArePassedOver) {
  const std::string text =
      "# costs, by \"me\nid,name\n  # one, two, three\n1,a\n#2,b\n3,#c\n"
      "\"#4\",d\n# the end";
  const auto table = ParseCsv(text, "t");
  ASSERT_TRUE(table.ok()) << ErrorMessage(table);
  EXPECT_THAT(table->header, ElementsAre("id", "name"));
  ASSERT_EQ(table->rows.size(), 3U);
  EXPECT_EQ(table->rows[0].line, 4);
  EXPECT_THAT(table->rows[1].fields, ElementsAre("3", "#c"));
  EXPECT_THAT(table->rows[2].fields, ElementsAre("#4", "d"));
}

TEST(Csv, AHeaderThatCannotBeReadSaysWhatToDo) {
  const testing::TempFolder folder;
  const auto complaint = [&](const std::string& text) {
    return ErrorMessage(ReadCsv(folder.Write("t.csv", text), {"id", "cost"}));
  };
  EXPECT_THAT(complaint("id;cost\n1;2,5\n"),
              HasSubstr("t.csv:1: the fields are separated by semicolons"));
  EXPECT_THAT(complaint("# c\nid\tcost\n1\t2\n"),
              HasSubstr("t.csv:2: the fields are separated by tabs"));
  EXPECT_THAT(complaint(std::string("\xFF\xFEi\0d\0", 6)), HasSubstr("UTF-16"));
  EXPECT_EQ(complaint("ID,Cost\n1,2\n"), "");
  EXPECT_THAT(complaint("ID,Id,Cost\n1,1,2\n"), HasSubstr("no column 'id'"));
}

TEST(Csv, AQuotedLineBreakKeepsTheLineNumbersRight) {
  const auto table = ParseCsv("a\n\"1\n2\"\n3\n", "t");
  ASSERT_TRUE(table.ok()) << ErrorMessage(table);
  EXPECT_EQ(table->rows[1].line, 4);
}

TEST(Csv, ErrorsNameTheFileAndTheLine) {
  EXPECT_THAT(ErrorMessage(ParseCsv("a,b\n1,2\n1,2,3\n", "t.csv")),
              StartsWith("t.csv:3: 3 fields where the header has 2"));
  EXPECT_THAT(ErrorMessage(ParseCsv("a\n\"1\n", "t.csv")),
              StartsWith("t.csv:2: a quote is not closed"));
  EXPECT_THAT(ErrorMessage(ParseCsv("a\n1\"2\n", "t.csv")),
              StartsWith("t.csv:2: a quote inside"));
  EXPECT_THAT(ErrorMessage(ParseCsv("a\n\"1\"2\n", "t.csv")),
              StartsWith("t.csv:2: text behind"));
  EXPECT_THAT(ErrorMessage(ParseCsv("a,a\n", "t.csv")), HasSubstr("twice"));
  EXPECT_THAT(ErrorMessage(ParseCsv("\n", "t.csv")), HasSubstr("no header"));
}

TEST(Csv, AMissingColumnIsNamed) {
  const testing::TempFolder folder;
  const std::string path = folder.Write("r.csv", "case_id,route\n");
  EXPECT_THAT(ErrorMessage(ReadCsv(path, {"case_id", "k"})),
              HasSubstr("no column 'k'"));
}

// What a CsvReader gives of a file, a line each; its error last.
std::vector<std::string> RowsOf(const std::string& path) {
  std::vector<std::string> rows;
  auto reader = CsvReader::Open(path, {"a"});
  if (!reader.ok()) return {ErrorMessage(reader)};
  EXPECT_EQ(reader->table().Column("a"), 0);
  for (;;) {
    const Result<std::optional<CsvRow>> row = reader->Next();
    if (!row.ok()) rows.push_back(ErrorMessage(row));
    if (!row.ok() || !row->has_value()) return rows;
    rows.push_back(std::to_string((*row)->line) + " " +
                   CsvLine((*row)->fields));
  }
}

TEST(Csv, RowByRowALongTableIsTheSame) {
  // Far more than is read at once, with line breaks inside fields.
  testing::Random random(3);
  std::string text =
      "\xEF\xBB\xBF"
      "a,b\r\n";
  for (int i = 0; i < 20'000; ++i) {
    text += CsvLine({std::to_string(i),
                     std::string(static_cast<std::size_t>(random.Int(0, 9)),
                                 "\n\",x"[random.Int(0, 3)])});
  }
  const testing::TempFolder folder;
  for (const char* end :
       {"last,1", "last,1\n", "last,\"1", "last\n", "# \"no\nlast,1", "#"}) {
    const std::string path = folder.Write("r.csv", text + end);
    const auto table = ParseCsv(text + end, path);
    std::vector<std::string> rows = RowsOf(path);
    if (!table.ok()) {
      EXPECT_EQ(rows.back(), ErrorMessage(table));
      continue;
    }
    ASSERT_EQ(rows.size(), table->rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const CsvRow& row = table->rows[i];
      ASSERT_EQ(rows[i], std::to_string(row.line) + " " + CsvLine(row.fields));
    }
  }
}

TEST(Csv, RowByRowFaultsAreNamed) {
  const testing::TempFolder folder;
  EXPECT_THAT(RowsOf(folder.Path("none")),
              ElementsAre(HasSubstr("no such file")));
  EXPECT_THAT(RowsOf(folder.Path("")),
              ElementsAre(HasSubstr("not a regular file")));
  EXPECT_THAT(RowsOf(folder.Write("r.csv", "\n")),
              ElementsAre(HasSubstr("no header")));
  EXPECT_THAT(RowsOf(folder.Write("r.csv", "b\n1\n")),
              ElementsAre(HasSubstr("no column 'a'")));
  EXPECT_THAT(RowsOf(folder.Write("r.csv", "a\n1\n1,2\n3\n")),
              ElementsAre("2 1\n", HasSubstr("r.csv:3: 2 fields")));
}

TEST(Csv, WhatIsWrittenIsReadBack) {
  testing::Random random(7);
  const std::string alphabet = "ab,\"\n\r ;#\t";
  for (int round = 0; round < 200; ++round) {
    std::vector<std::string> fields(3);
    for (std::string& field : fields) {
      for (int i = random.Int(1, 6); i > 0; --i) {
        field += alphabet[static_cast<std::size_t>(random.Int(0, 9))];
      }
    }
    const auto table = ParseCsv("x,y,z\n" + CsvLine(fields), "t");
    ASSERT_TRUE(table.ok()) << ErrorMessage(table);
    EXPECT_EQ(table->rows.at(0).fields, fields);
  }
}

TEST(Csv, NumbersKeepEveryBitAndInfinity) {
  for (const double value : {0.1, 1e300, 2827.410314079376, 1.0 / 3}) {
    EXPECT_EQ(ParseNumber(FormatNumber(value)).value(), value);
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(FormatNumber(kInfinity), "inf");
  for (const char* text : {"inf", "Inf", "INF", "+inf", "Infinity"}) {
    EXPECT_EQ(ParseNumber(text).value(), kInfinity) << text;
  }
}

TEST(Csv, WhatIsNoNumberIsRefused) {
  for (const char* text : {"", "x", "1x", " 1", "nan", "1e999", "-", "-inf",
                           "1.5 m", "1,5", "infinite"}) {
    EXPECT_FALSE(ParseNumber(text).ok()) << text;
  }
  for (const char* text : {"", "1.5", "99999999999", "0x1", "+1"}) {
    EXPECT_FALSE(ParseInteger(text).ok()) << text;
  }
  EXPECT_THAT(ErrorMessage(ParseNumber("1,5")), HasSubstr("a point: 1.5"));
}

}  // namespace
}  // namespace terra
