#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/statistics.h"

namespace terra::benchmark {

/// A cell of a table: text, and the ends of an interval where it has one.
struct TableCell {
  std::string text;
  std::string low;
  std::string high;

  TableCell() = default;
  // Implicit on purpose: rows are written as lists of texts and figures.
  TableCell(std::string t) : text(std::move(t)) {}  // NOLINT
  TableCell(const char* t) : text(t) {}             // NOLINT
};

struct TableColumn {
  std::string name;
  bool interval = false;  ///< Its cells have 95 % intervals.
  bool words = false;     ///< Its cells are words, set to the left.
};

/// Rows that belong together under a heading.
struct TableBlock {
  std::string heading;     ///< Empty = none.
  bool published = false;  ///< Printed elsewhere: never ranked or subtracted.
  std::vector<std::vector<TableCell>> rows;
};

/// A column of words; the first one always is.
inline TableColumn WordColumn(std::string name) {
  return {std::move(name), false, true};
}

/// A table as data; the first column names the row. A row with fewer cells than
/// columns says something in words: its last cell spans the rest.
struct Table {
  std::string id;  ///< Of files and anchors: "comparison-easy".
  std::string title;
  std::vector<std::string> notes;
  std::vector<TableColumn> columns;
  std::vector<TableBlock> blocks;
};

/// The same table in four forms. CSV has a column for each end of an interval
/// and one that names the block. LaTeX needs the package booktabs.
std::string ToCsv(const Table& table);
std::string ToMarkdown(const Table& table);
std::string ToLatex(const Table& table);
std::string ToHtml(const Table& table);

/// Figures as cells; "-" where there is none.
TableCell CountCell(std::int64_t n);
TableCell NumberCell(std::optional<double> value, int digits);
/// Seconds to four decimals, below 10 ms to six.
TableCell SecondsCell(std::optional<double> value);
TableCell PercentCell(const std::optional<Estimate>& estimate);

}  // namespace terra::benchmark
