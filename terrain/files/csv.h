#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "terrain/result.h"

namespace terra {

/// One record of a CSV file.
struct CsvRow {
  int line = 0;  ///< Where it begins, from 1.
  std::vector<std::string> fields;
};

/// A CSV file with a header row; every row has as many fields as the header.
struct CsvTable {
  std::vector<std::string> header;
  std::vector<CsvRow> rows;

  /// Returns the index of a column, or -1.
  int Column(std::string_view name) const;
};

/// Reads CSV after RFC 4180: comma, double quotes, quotes doubled inside them;
/// LF or CRLF, a byte order mark and empty lines are passed over.
/// `name` is used in errors, which name the line.
Result<CsvTable> ParseCsv(std::string_view text, const std::string& name);

/// Reads a CSV file that must have these columns, in any order and among
/// others.
Result<CsvTable> ReadCsv(const std::string& path,
                         std::initializer_list<std::string_view> columns);

/// What is done with a record; `table` has the header and no rows.
using CsvRowUse = std::function<Status(const CsvTable& table, CsvRow row)>;

/// The same for tables of any length: record by record, in bounded memory. An
/// error of `use` ends it.
Status ReadCsvRows(const std::string& path,
                   std::initializer_list<std::string_view> columns,
                   const CsvRowUse& use);

/// Returns one line of CSV with its line feed, quoting where needed.
std::string CsvLine(const std::vector<std::string>& fields);

/// Numbers as they stand in CSV: the shortest text that reads back to the same
/// double, or "inf".
std::string FormatNumber(double value);

/// Reads a whole field as a number ("inf" included) or integer.
Result<double> ParseNumber(std::string_view text);
Result<int> ParseInteger(std::string_view text);

}  // namespace terra
