#include "terrain/files/csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "terrain/files/whole_file.h"

namespace terra {
namespace {

constexpr std::size_t kMaxCsvBytes = std::size_t{1} << 30;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

Error LineError(const std::string& name, int line, const std::string& what) {
  return Error{ErrorCode::kInvalid,
               name + ":" + std::to_string(line) + ": " + what};
}

// Cuts a text into records; a cursor that counts lines.
class CsvScanner {
 public:
  CsvScanner(std::string_view text, const std::string& name)
      : text_(text), name_(name) {}

  bool AtEnd() const { return at_ == text_.size(); }

  Result<CsvRow> Next() {
    CsvRow row;
    row.line = line_;
    for (;;) {
      Status field = TakeField(row);
      if (!field.ok()) return field.error();
      if (AtEnd() || TakeLineEnd()) return row;
      ++at_;  // the comma
    }
  }

 private:
  char Peek() const { return text_[at_]; }
  bool AtLineEnd() const {
    return AtEnd() || Peek() == '\n' ||
           (Peek() == '\r' &&
            (at_ + 1 == text_.size() || text_[at_ + 1] == '\n'));
  }
  bool TakeLineEnd() {
    if (!AtLineEnd()) return false;
    if (!AtEnd() && Peek() == '\r') ++at_;
    if (!AtEnd() && Peek() == '\n') ++at_;
    ++line_;
    return true;
  }

  // Takes one field, up to the comma or line end behind it.
  Status TakeField(CsvRow& row) {
    std::string& field = row.fields.emplace_back();
    if (AtEnd() || Peek() != '"') {
      while (!AtLineEnd() && Peek() != ',') {
        if (Peek() == '"') {
          return LineError(name_, line_, "a quote inside an unquoted field");
        }
        field += text_[at_++];
      }
      return Done{};
    }
    ++at_;
    while (!AtEnd()) {
      const char c = text_[at_++];
      if (c == '"') {
        if (AtEnd() || Peek() != '"') return CheckFieldEnd();
        ++at_;
      }
      if (c == '\n') ++line_;
      field += c;
    }
    return LineError(name_, row.line, "a quote is not closed");
  }

  Status CheckFieldEnd() {
    if (AtLineEnd() || Peek() == ',') return Done{};
    return LineError(name_, line_, "text behind a closing quote");
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 1;
};

bool IsEmptyLine(const CsvRow& row) {
  return row.fields.size() == 1 && row.fields[0].empty();
}

Status CheckHeader(const std::vector<std::string>& header,
                   const std::string& name) {
  std::vector<std::string> sorted = header;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) {
    return LineError(name, 1, "the column '" + *twice + "' comes twice");
  }
  return Done{};
}

}  // namespace

int CsvTable::Column(std::string_view name) const {
  const auto found = std::find(header.begin(), header.end(), name);
  return found == header.end() ? -1 : static_cast<int>(found - header.begin());
}

Result<CsvTable> ParseCsv(std::string_view text, const std::string& name) {
  if (text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());
  }
  CsvTable table;
  CsvScanner scanner(text, name);
  while (!scanner.AtEnd()) {
    Result<CsvRow> row = scanner.Next();
    if (!row.ok()) return row.error();
    if (IsEmptyLine(*row)) continue;
    if (table.header.empty()) {
      table.header = std::move(row->fields);
      Status header = CheckHeader(table.header, name);
      if (!header.ok()) return header.error();
      continue;
    }
    if (row->fields.size() != table.header.size()) {
      return LineError(name, row->line,
                       std::to_string(row->fields.size()) +
                           " fields where the header has " +
                           std::to_string(table.header.size()) +
                           " (fields with a comma need quotes)");
    }
    table.rows.push_back(std::move(*row));
  }
  if (table.header.empty()) {
    return Error{ErrorCode::kInvalid, name + ": empty, no header row"};
  }
  return table;
}

Result<CsvTable> ReadCsv(const std::string& path,
                         std::initializer_list<std::string_view> columns) {
  const Result<std::string> text = ReadWholeFile(path, kMaxCsvBytes);
  if (!text.ok()) return text.error();
  Result<CsvTable> table = ParseCsv(*text, path);
  if (!table.ok()) return table.error();
  for (const std::string_view column : columns) {
    if (table->Column(column) < 0) {
      std::string wanted;
      for (const std::string_view name : columns) {
        wanted += (wanted.empty() ? "" : ",") + std::string(name);
      }
      return LineError(path, 1,
                       "no column '" + std::string(column) +
                           "'; the header must have " + wanted);
    }
  }
  return table;
}

std::string CsvLine(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) line += ',';
    // At the start of a text a byte order mark would not be read back.
    if (fields[i].find_first_of(",\"\r\n") == std::string::npos &&
        !fields[i].starts_with(kByteOrderMark)) {
      line += fields[i];
      continue;
    }
    line += '"';
    for (const char c : fields[i]) {
      if (c == '"') line += '"';
      line += c;
    }
    line += '"';
  }
  return line + "\n";
}

std::string FormatNumber(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::array<char, 32> buffer{};
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return std::string(buffer.data(), end.ptr);
}

Result<double> ParseNumber(std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  if (text == "inf") return std::numeric_limits<double>::infinity();
  if (parsed.ec != std::errc() || parsed.ptr != end || !std::isfinite(value)) {
    return Error{ErrorCode::kInvalid,
                 "'" + std::string(text) + "' is not a number"};
  }
  return value;
}

Result<int> ParseInteger(std::string_view text) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  if (parsed.ec != std::errc() || parsed.ptr != end) {
    return Error{ErrorCode::kInvalid,
                 "'" + std::string(text) + "' is not an integer"};
  }
  return value;
}

}  // namespace terra
