#include "terrain/files/csv.h"

#include <algorithm>
#include <utility>

#include "terrain/files/whole_file.h"

namespace terra {
namespace {

constexpr std::size_t kMaxCsvBytes = std::size_t{1} << 30;

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

Status CheckWidth(const CsvRow& row, const std::vector<std::string>& header,
                  const std::string& name) {
  if (row.fields.size() == header.size()) return Done{};
  return LineError(
      name, row.line,
      std::to_string(row.fields.size()) + " fields where the header has " +
          std::to_string(header.size()) + " (fields with a comma need quotes)");
}

Error NoHeader(const std::string& name) {
  return {ErrorCode::kInvalid, name + ": empty, no header row"};
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
  if (text.starts_with(kCsvByteOrderMark)) {
    text.remove_prefix(kCsvByteOrderMark.size());
  }
  CsvTable table;
  CsvScanner scanner(text, name, 1);
  while (!scanner.AtEnd()) {
    Result<CsvRow> row = scanner.Next();
    if (!row.ok()) return row.error();
    if (IsEmptyLine(*row)) continue;
    const bool first = table.header.empty();
    const Status checked = first ? CheckHeader(row->fields, name)
                                 : CheckWidth(*row, table.header, name);
    if (!checked.ok()) return checked.error();
    if (first) {
      table.header = std::move(row->fields);
    } else {
      table.rows.push_back(*std::move(row));
    }
  }
  if (table.header.empty()) return NoHeader(name);
  return table;
}

Result<CsvRow> ParseCsvRecord(std::string_view record, const std::string& name,
                              int line) {
  return CsvScanner(record, name, line).Next();
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

Result<CsvReader> CsvReader::Open(
    const std::string& path, std::initializer_list<std::string_view> columns) {
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines.ok()) return lines.error();
  CsvReader reader(path, *std::move(lines));
  Result<std::optional<CsvRow>> header = reader.NextRecord();
  if (!header.ok()) return header.error();
  if (!header->has_value()) return NoHeader(path);
  reader.table_.header = std::move((*header)->fields);
  const Status checked = CheckHeader(reader.table_.header, path);
  if (!checked.ok()) return checked.error();
  const Status complete = CheckColumns(reader.table_, path, columns);
  if (!complete.ok()) return complete.error();
  return reader;
}

Result<std::optional<CsvRow>> CsvReader::Next() {
  Result<std::optional<CsvRow>> row = NextRecord();
  if (!row.ok() || !row->has_value()) return row;
  const Status checked = CheckWidth(**row, table_.header, path_);
  if (!checked.ok()) return checked.error();
  return row;
}

Result<std::optional<CsvRow>> CsvReader::NextRecord() {
  for (;;) {
    const int first = lines_.place().line;
    const Result<bool> taken = TakeRecord();
    if (!taken.ok()) return taken.error();
    if (!*taken) return std::optional<CsvRow>();
    std::string_view record = record_;
    if (first == 1 && record.starts_with(kCsvByteOrderMark)) {
      record.remove_prefix(kCsvByteOrderMark.size());
    }
    CsvScanner scanner(record, path_, first);
    if (scanner.AtEnd()) continue;  // Nothing but the byte order mark.
    Result<CsvRow> row = scanner.Next();
    if (!row.ok()) return row.error();
    if (!IsEmptyLine(*row)) return std::optional(*std::move(row));
  }
}

// An odd number of quotes so far means that a line break is inside a field.
Result<bool> CsvReader::TakeRecord() {
  record_.clear();
  bool inside = false;
  do {
    const Result<bool> taken = lines_.Next();
    if (!taken.ok()) return taken.error();
    if (!*taken) break;
    const std::string& line = lines_.line();
    if (std::count(line.begin(), line.end(), '"') % 2 == 1) inside = !inside;
    record_ += line;
  } while (inside && record_.size() < LineReader::kMaxLineBytes);
  return !record_.empty();
}

}  // namespace terra
