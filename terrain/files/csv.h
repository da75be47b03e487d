#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "terrain/files/line_reader.h"
#include "terrain/result.h"

namespace terra {

/// One record of a CSV file.
struct CsvRow {
  int line = 0;  ///< Where it begins, from 1.
  std::vector<std::string> fields;
};

/// A CSV file with a header row; every row has as many fields as the header.
struct CsvTable {
  int header_line = 1;
  std::vector<std::string> header;
  std::vector<CsvRow> rows;

  /// Returns the index of a column, or -1.
  int Column(std::string_view name) const;
};

/// Reads CSV after RFC 4180: comma, double quotes, quotes doubled inside them;
/// LF or CRLF, a byte order mark and empty lines are passed over. Beyond it,
/// for tables written by hand: blanks around fields do not count, and lines
/// that begin with # are comments (a first field that does needs quotes).
/// `name` is used in errors, which name the line.
Result<CsvTable> ParseCsv(std::string_view text, const std::string& name);

/// Reads a CSV file that must have these columns, in any order and among
/// others; their names may be in capitals.
Result<CsvTable> ReadCsv(const std::string& path,
                         std::initializer_list<std::string_view> columns);

/// Reads one record, which may have line breaks in quotes; it begins in this
/// line and is no comment.
Result<CsvRow> ParseCsvRecord(std::string_view record, const std::string& name,
                              int line);

/// The same for tables of any length: record by record, in bounded memory (a
/// record has at most 2 LineReader::kMaxLineBytes).
class CsvReader {
 public:
  /// Reads the header. Errors: as ReadCsv.
  static Result<CsvReader> Open(
      const std::string& path, std::initializer_list<std::string_view> columns);

  /// The header; it has no rows.
  const CsvTable& table() const { return table_; }

  /// The next record; none at the end.
  Result<std::optional<CsvRow>> Next();

 private:
  CsvReader(std::string path, LineReader lines)
      : path_(std::move(path)), lines_(std::move(lines)) {}

  Result<std::optional<CsvRow>> NextRecord();
  Result<bool> TakeRecord();

  std::string path_;
  LineReader lines_;
  CsvTable table_;
  std::string record_;
};

/// Excel and others put it before a text in UTF-8.
inline constexpr std::string_view kCsvByteOrderMark = "\xEF\xBB\xBF";

/// Returns one line of CSV with its line feed, quoting where needed.
std::string CsvLine(const std::vector<std::string>& fields);

/// Numbers as they stand in CSV: the shortest text that reads back to the same
/// double, or "inf".
std::string FormatNumber(double value);

/// Reads a whole field as a number or integer. Infinity is `inf` or `infinity`
/// in capitals or not.
Result<double> ParseNumber(std::string_view text);
Result<int> ParseInteger(std::string_view text);

}  // namespace terra
