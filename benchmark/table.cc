#include "benchmark/table.h"

#include <array>
#include <cstdio>
#include <string_view>
#include <utility>

#include "base/html.h"
#include "terrain/files/csv.h"

namespace terra::benchmark {
namespace {

std::string Fixed(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string Replaced(
    std::string_view text,
    const std::vector<std::pair<char, std::string_view>>& replacements) {
  std::string result;
  for (const char c : text) {
    std::string_view with(&c, 1);
    for (const auto& [from, to] : replacements) {
      if (from == c) with = to;
    }
    result += with;
  }
  return result;
}

std::string EscapeMarkdown(const std::string& text) {
  return Replaced(text, {{'|', "\\|"}, {'\n', " "}, {'*', "\\*"}});
}

std::string EscapeLatex(const std::string& text) {
  return Replaced(text, {{'%', "\\%"},
                         {'&', "\\&"},
                         {'#', "\\#"},
                         {'$', "\\$"},
                         {'_', "\\_"},
                         {'{', "\\{"},
                         {'}', "\\}"},
                         {'~', "\\textasciitilde{}"},
                         {'^', "\\textasciicircum{}"},
                         {'\\', "\\textbackslash{}"}});
}

std::string WithInterval(const TableCell& cell) {
  if (cell.low.empty()) return cell.text;
  return cell.text + " [" + cell.low + ", " + cell.high + "]";
}

void AppendCsvCell(const TableColumn& column, const TableCell& cell,
                   std::vector<std::string>& fields) {
  fields.push_back(cell.text);
  if (!column.interval) return;
  fields.push_back(cell.low);
  fields.push_back(cell.high);
}

bool IsWords(const Table& table, std::size_t column) {
  return column == 0 || table.columns[column].words;
}

// The letters of LaTeX's tabular.
std::string ColumnLetters(const Table& table) {
  std::string letters;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    letters += IsWords(table, i) ? 'l' : 'r';
  }
  return letters;
}

// Beside a minus sign a dash cannot be told from one.
std::string HtmlInterval(const TableCell& cell) {
  const bool negative = cell.low.front() == '-' || cell.high.front() == '-';
  return EscapeHtml(cell.low) + (negative ? " to " : " – ") +
         EscapeHtml(cell.high);
}

std::string HtmlClass(const Table& table, std::size_t column) {
  return IsWords(table, column) ? " class=\"words\"" : "";
}

}  // namespace

TableCell CountCell(std::int64_t n) {
  return std::to_string(n);
}

TableCell NumberCell(std::optional<double> value, int digits) {
  return value ? Fixed(*value, digits) : "-";
}

TableCell SecondsCell(std::optional<double> value) {
  return NumberCell(value, value && *value < 0.01 ? 6 : 4);
}

TableCell PercentCell(const std::optional<Estimate>& estimate) {
  if (!estimate) return "-";
  TableCell cell(Fixed(100 * estimate->value, 2));
  cell.low = Fixed(100 * estimate->low, 2);
  cell.high = Fixed(100 * estimate->high, 2);
  return cell;
}

std::string ToCsv(const Table& table) {
  std::vector<std::string> header = {"block"};
  for (const TableColumn& column : table.columns) {
    header.push_back(column.name);
    if (!column.interval) continue;
    header.push_back(column.name + " low");
    header.push_back(column.name + " high");
  }
  std::string text = CsvLine(header);
  for (const TableBlock& block : table.blocks) {
    for (const auto& row : block.rows) {
      std::vector<std::string> fields = {block.heading};
      for (std::size_t i = 0; i < row.size(); ++i) {
        AppendCsvCell(table.columns[i], row[i], fields);
      }
      fields.resize(header.size());
      text += CsvLine(fields);
    }
  }
  return text;
}

std::string ToMarkdown(const Table& table) {
  std::string text = "**" + EscapeMarkdown(table.title) + "**\n\n|";
  std::string rule = "|";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    text += " " + EscapeMarkdown(table.columns[i].name) + " |";
    rule += IsWords(table, i) ? "---|" : "--:|";
  }
  text += "\n" + rule + "\n";
  for (const TableBlock& block : table.blocks) {
    if (!block.heading.empty()) {
      text += "| *" + EscapeMarkdown(block.heading) + "* |";
      for (std::size_t i = 1; i < table.columns.size(); ++i) text += " |";
      text += "\n";
    }
    for (const auto& row : block.rows) {
      text += "|";
      for (const TableCell& cell : row) {
        text += " " + EscapeMarkdown(WithInterval(cell)) + " |";
      }
      for (std::size_t i = row.size(); i < table.columns.size(); ++i) {
        text += " |";
      }
      text += "\n";
    }
  }
  text += "\n";
  for (const std::string& note : table.notes) {
    text += "- " + EscapeMarkdown(note) + "\n";
  }
  return text;
}

std::string ToLatex(const Table& table) {
  const std::string width = std::to_string(table.columns.size());
  std::string text = "\\begin{table*}\n\\centering\n\\caption{" +
                     EscapeLatex(table.title) + "}\n\\label{tab:" + table.id +
                     "}\n\\resizebox{\\textwidth}{!}{\n\\begin{tabular}{" +
                     ColumnLetters(table) + "}\n\\toprule\n";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    text += (i == 0 ? "" : " & ") + EscapeLatex(table.columns[i].name);
  }
  text += " \\\\\n";
  for (const TableBlock& block : table.blocks) {
    text += "\\midrule\n";
    if (!block.heading.empty()) {
      text += "\\multicolumn{" + width + "}{l}{\\textit{" +
              EscapeLatex(block.heading) + "}} \\\\\n";
    }
    for (const auto& row : block.rows) {
      for (std::size_t i = 0; i < row.size(); ++i) {
        const std::size_t span = table.columns.size() - i;
        const bool spans = i + 1 == row.size() && span > 1;
        const std::string cell = EscapeLatex(WithInterval(row[i]));
        text += (i == 0 ? "" : " & ") +
                (spans ? "\\multicolumn{" + std::to_string(span) + "}{l}{" +
                             cell + "}"
                       : cell);
      }
      text += " \\\\\n";
    }
  }
  text += "\\bottomrule\n\\end{tabular}}\n";
  for (const std::string& note : table.notes) {
    text += "\\par\\footnotesize " + EscapeLatex(note) + "\n";
  }
  return text + "\\end{table*}\n";
}

namespace {

std::string HtmlRow(const Table& table, const TableBlock& block,
                    const std::vector<TableCell>& row) {
  std::string text = block.published ? "<tr class=\"published\">" : "<tr>";
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::size_t span = table.columns.size() - i;
    const bool spans = i + 1 == row.size() && span > 1;
    const std::string tag = i == 0 ? "th" : "td";
    text += "<" + tag;
    text += spans
                ? " class=\"command\" colspan=\"" + std::to_string(span) + "\""
                : HtmlClass(table, i);
    text += ">" + EscapeHtml(row[i].text);
    if (!row[i].low.empty()) {
      text += "<span class=\"interval\">" + HtmlInterval(row[i]) + "</span>";
    }
    text += "</" + tag + ">";
  }
  return text + "</tr>\n";
}

}  // namespace

std::string ToHtml(const Table& table) {
  std::string text =
      "<figure class=\"table\" id=\"" + table.id + "\">\n<figcaption>" +
      EscapeHtml(table.title) +
      "</figcaption>\n<div class=\"scroll\"><table>\n<thead><tr>";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    text += "<th" + HtmlClass(table, i) + ">" +
            EscapeHtml(table.columns[i].name) + "</th>";
  }
  text += "</tr></thead>\n";
  for (const TableBlock& block : table.blocks) {
    text += "<tbody>\n";
    if (!block.heading.empty()) {
      text += "<tr class=\"heading\"><th colspan=\"" +
              std::to_string(table.columns.size()) + "\">" +
              EscapeHtml(block.heading) + "</th></tr>\n";
    }
    for (const auto& row : block.rows) text += HtmlRow(table, block, row);
    text += "</tbody>\n";
  }
  text += "</table></div>\n";
  for (const std::string& note : table.notes) {
    text += "<p class=\"note\">" + EscapeHtml(note) + "</p>\n";
  }
  return text + "</figure>\n";
}

}  // namespace terra::benchmark
