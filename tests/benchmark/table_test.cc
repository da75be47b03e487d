#include "benchmark/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmark/paper_rows.h"

namespace terra::benchmark {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Table SmallTable() {
  Table table;
  table.id = "small";
  table.title = "A & B";
  table.columns = {{"Method"}, {"N_Lower"}, {"FIR %", true}};
  TableBlock measured;
  measured.heading = "Measured here";
  measured.rows = {
      {"a|b", CountCell(3), PercentCell(Estimate{0.5, 0.25, 0.75})},
      {"none", "-", PercentCell(std::nullopt)},
      {"c", "not measured; run <this>"}};
  table.blocks = {measured};
  table.notes = {"A note."};
  return table;
}

TEST(Table, AsCsvHasAColumnForEachEndOfAnInterval) {
  EXPECT_EQ(ToCsv(SmallTable()),
            "block,Method,N_Lower,FIR %,FIR % low,FIR % high\n"
            "Measured here,a|b,3,50.00,25.00,75.00\n"
            "Measured here,none,-,-,,\n"
            "Measured here,c,not measured; run <this>,,,\n");
}

TEST(Table, AsMarkdownEscapesBarsAndKeepsTheWidth) {
  const std::string text = ToMarkdown(SmallTable());
  EXPECT_THAT(text, HasSubstr("| a\\|b | 3 | 50.00 [25.00, 75.00] |\n"));
  EXPECT_THAT(text, HasSubstr("| c | not measured; run <this> | |\n"));
  EXPECT_THAT(text, HasSubstr("- A note."));
}

TEST(Table, AsLatexEscapesAndSpans) {
  const std::string text = ToLatex(SmallTable());
  EXPECT_THAT(text, HasSubstr("\\caption{A \\& B}"));
  EXPECT_THAT(text, HasSubstr("N\\_Lower & FIR \\%"));
  EXPECT_THAT(text,
              HasSubstr("c & \\multicolumn{2}{l}{not measured; run <this>}"));
}

TEST(Table, AsHtmlEscapesAndSpans) {
  const std::string text = ToHtml(SmallTable());
  EXPECT_THAT(text, HasSubstr("A &amp; B"));
  EXPECT_THAT(text, HasSubstr("colspan=\"2\">not measured; run &lt;this&gt;"));
  EXPECT_THAT(text, Not(HasSubstr("<this>")));
}

TEST(PaperBlock, StandsApartUnderItsHeading) {
  const std::vector<TableColumn> columns = {
      {"Method"}, {"N_Lower"}, {"Ours alone"}, {"FIR %", true}};
  const TableBlock block = PaperBlock("comparison-hard", columns);
  EXPECT_TRUE(block.published);
  EXPECT_THAT(block.heading, HasSubstr("not comparable number by number"));
  ASSERT_EQ(block.rows.size(), 7U);
  EXPECT_EQ(block.rows[4][0].text, "LLM-Advisor (GPT-5.5) + coarse-lattice A*");
  EXPECT_EQ(block.rows[4][1].text, "450");
  EXPECT_EQ(block.rows[4][2].text, "-");
  EXPECT_EQ(block.rows[4][3].text, "45.00");
}

TEST(PaperBlock, ItsCountsAddUpToItsRates) {
  // A check of the typing: N_Lower / 1,000 is FIR in both comparison tables.
  for (const char* id : {"comparison-easy", "comparison-hard"}) {
    const TableBlock block = PaperBlock(id, {{"N_Lower"}, {"FIR %"}});
    for (const auto& row : block.rows) {
      EXPECT_DOUBLE_EQ(std::stod(row[0].text) / 10, std::stod(row[1].text));
    }
  }
}

}  // namespace
}  // namespace terra::benchmark
