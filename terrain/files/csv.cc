#include "terrain/files/csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <utility>

#include "terrain/files/whole_file.h"

namespace terra {
namespace {

constexpr std::size_t kMaxCsvBytes = std::size_t{1} << 30;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

using CsvUse = std::function<Status(CsvRow)>;

Error LineError(const std::string& name, int line, const std::string& what) {
  return Error{ErrorCode::kInvalid,
               name + ":" + std::to_string(line) + ": " + what};
}

// Cuts a text into records; a cursor that counts lines.
class CsvScanner {
 public:
  CsvScanner(std::string_view text, const std::string& name, int line)
      : text_(text), name_(name), line_(line) {}

  bool AtEnd() const { return at_ == text_.size(); }
  int line() const { return line_; }

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
  int line_;
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

// Reads a table that comes in parts, each of whole records.
class TableReader {
 public:
  explicit TableReader(const std::string& name) : name_(name) {}

  Status Take(std::string_view part, const CsvUse& use) {
    if (line_ == 1 && part.starts_with(kByteOrderMark)) {
      part.remove_prefix(kByteOrderMark.size());
    }
    CsvScanner scanner(part, name_, line_);
    while (!scanner.AtEnd()) {
      Result<CsvRow> row = scanner.Next();
      if (!row.ok()) return row.error();
      if (IsEmptyLine(*row)) continue;
      const Status taken = TakeRow(*std::move(row), use);
      if (!taken.ok()) return taken;
    }
    line_ = scanner.line();
    return Done{};
  }

  Status Finish() const {
    if (!header_.empty()) return Done{};
    return Error{ErrorCode::kInvalid, name_ + ": empty, no header row"};
  }

 private:
  Status TakeRow(CsvRow row, const CsvUse& use) {
    if (header_.empty()) {
      header_ = row.fields;
      const Status header = CheckHeader(header_, name_);
      return header.ok() ? use(std::move(row)) : header;
    }
    if (row.fields.size() != header_.size()) {
      return LineError(name_, row.line,
                       std::to_string(row.fields.size()) +
                           " fields where the header has " +
                           std::to_string(header_.size()) +
                           " (fields with a comma need quotes)");
    }
    return use(std::move(row));
  }

  const std::string& name_;
  std::vector<std::string> header_;
  int line_ = 1;
};

// Whole records, some at a time: an odd number of quotes so far means that a
// line break is inside a field.
bool NextPart(std::ifstream& file, std::string& part) {
  constexpr std::size_t kPartBytes = std::size_t{1} << 16;
  part.clear();
  std::string line;
  bool inside = false;
  while ((inside || part.size() < kPartBytes) && std::getline(file, line)) {
    if (std::count(line.begin(), line.end(), '"') % 2 == 1) inside = !inside;
    part += line;
    if (!file.eof()) part += '\n';
  }
  return !part.empty();
}

Status CheckColumns(const CsvTable& table, const std::string& path,
                    std::initializer_list<std::string_view> columns) {
  for (const std::string_view column : columns) {
    if (table.Column(column) >= 0) continue;
    std::string wanted;
    for (const std::string_view name : columns) {
      wanted += (wanted.empty() ? "" : ",") + std::string(name);
    }
    return LineError(path, 1,
                     "no column '" + std::string(column) +
                         "'; the header must have " + wanted);
  }
  return Done{};
}

}  // namespace

int CsvTable::Column(std::string_view name) const {
  const auto found = std::find(header.begin(), header.end(), name);
  return found == header.end() ? -1 : static_cast<int>(found - header.begin());
}

Result<CsvTable> ParseCsv(std::string_view text, const std::string& name) {
  CsvTable table;
  TableReader reader(name);
  const Status read = reader.Take(text, [&](CsvRow row) -> Status {
    if (table.header.empty()) {
      table.header = std::move(row.fields);
    } else {
      table.rows.push_back(std::move(row));
    }
    return Done{};
  });
  if (!read.ok()) return read.error();
  const Status finished = reader.Finish();
  if (!finished.ok()) return finished.error();
  return table;
}

Result<CsvTable> ReadCsv(const std::string& path,
                         std::initializer_list<std::string_view> columns) {
  const Result<std::string> text = ReadWholeFile(path, kMaxCsvBytes);
  if (!text.ok()) return text.error();
  Result<CsvTable> table = ParseCsv(*text, path);
  if (!table.ok()) return table.error();
  const Status checked = CheckColumns(*table, path, columns);
  if (!checked.ok()) return checked.error();
  return table;
}

Status ReadCsvRows(const std::string& path,
                   std::initializer_list<std::string_view> columns,
                   const CsvRowUse& use) {
  Result<std::ifstream> file = OpenToRead(path);
  if (!file.ok()) return file.error();
  CsvTable table;  // Of its rows there is never one.
  TableReader reader(path);
  for (std::string part; NextPart(*file, part);) {
    const Status read = reader.Take(part, [&](CsvRow row) -> Status {
      if (!table.header.empty()) return use(table, std::move(row));
      table.header = std::move(row.fields);
      return CheckColumns(table, path, columns);
    });
    if (!read.ok()) return read.error();
  }
  if (file->bad()) {
    return Error{ErrorCode::kUnavailable, path + ": cannot be read"};
  }
  return reader.Finish();
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
