#include "terrain/files/csv.h"

#include <algorithm>
#include <utility>

#include "terrain/files/ascii_case.h"
#include "terrain/files/whole_file.h"

namespace terra {
namespace {

constexpr std::size_t kMaxCsvBytes = std::size_t{1} << 30;

Error LineError(const std::string& name, int line, const std::string& what) {
  return Error{ErrorCode::kInvalid,
               name + ":" + std::to_string(line) + ": " + what};
}

bool IsBlank(char c) {
  return c == ' ' || c == '\t';
}

// Is the first line of this text a comment?
bool BeginsWithComment(std::string_view text) {
  const auto first = std::find_if_not(text.begin(), text.end(), IsBlank);
  return first != text.end() && *first == '#';
}

// Cuts a text into records; a cursor that counts lines.
class CsvScanner {
 public:
  CsvScanner(std::string_view text, const std::string& name, int line)
      : text_(text), name_(name), line_(line) {}

  bool AtEnd() const { return at_ == text_.size(); }

  void SkipComments() {
    while (BeginsWithComment(text_.substr(at_))) {
      at_ = std::min(text_.find('\n', at_), text_.size() - 1) + 1;
      ++line_;
    }
  }

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

  void SkipBlanks() {
    while (!AtEnd() && IsBlank(Peek())) ++at_;
  }

  // Takes one field, up to the comma or line end behind it.
  Status TakeField(CsvRow& row) {
    std::string& field = row.fields.emplace_back();
    SkipBlanks();
    if (AtEnd() || Peek() != '"') {
      while (!AtLineEnd() && Peek() != ',') {
        if (Peek() == '"') {
          return LineError(name_, line_, "a quote inside an unquoted field");
        }
        field += text_[at_++];
      }
      while (!field.empty() && IsBlank(field.back())) field.pop_back();
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
    SkipBlanks();
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

// Why a header is none of a CSV file, where that is plain; else empty.
std::string WhyNoHeader(const std::vector<std::string>& header) {
  const std::string& first = header.front();
  if (first.starts_with("\xFF\xFE") || first.starts_with("\xFE\xFF")) {
    return "this is UTF-16 text; save it as CSV in UTF-8";
  }
  if (header.size() > 1) return "";
  for (const auto& [separator, name] :
       {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}}) {
    if (first.find(separator) == std::string::npos) continue;
    return std::string("the fields are separated by ") + name +
           "; write commas (and numbers with a point)";
  }
  return "";
}

Status CheckHeader(const CsvRow& header, const std::string& name) {
  const std::string why = WhyNoHeader(header.fields);
  if (!why.empty()) return LineError(name, header.line, why);
  std::vector<std::string> sorted = header.fields;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) {
    return LineError(name, header.line,
                     "the column '" + *twice + "' comes twice");
  }
  return Done{};
}

Status CheckWidth(const CsvRow& row, const std::vector<std::string>& header,
                  const std::string& name) {
  if (row.fields.size() == header.size()) return Done{};
  return LineError(
      name, row.line,
      std::to_string(row.fields.size()) + " fields where the header has " +
          std::to_string(header.size()) +
          " (a field with a comma needs quotes, a number has a point: 1.5)");
}

Error NoHeader(const std::string& name) {
  return {ErrorCode::kInvalid, name + ": empty, no header row"};
}

// Gives a column its usual name where one, and no other, has it in capitals.
void RenameColumn(CsvTable& table, std::string_view column) {
  const auto is_it = [&](const std::string& name) {
    return EqualsInAnyCase(name, column);
  };
  auto& header = table.header;
  if (std::count_if(header.begin(), header.end(), is_it) != 1) return;
  *std::find_if(header.begin(), header.end(), is_it) = column;
}

Status CheckColumns(CsvTable& table, const std::string& path, int line,
                    std::initializer_list<std::string_view> columns) {
  for (const std::string_view column : columns) {
    if (table.Column(column) < 0) RenameColumn(table, column);
    if (table.Column(column) >= 0) continue;
    std::string wanted;
    for (const std::string_view name : columns) {
      wanted += (wanted.empty() ? "" : ",") + std::string(name);
    }
    return LineError(path, line,
                     "no column '" + std::string(column) +
                         "'; the header must have " + wanted);
  }
  return Done{};
}

// A text that begins in this line of a file.
std::string_view WithoutByteOrderMark(std::string_view text, int line) {
  if (line == 1 && text.starts_with(kCsvByteOrderMark)) {
    text.remove_prefix(kCsvByteOrderMark.size());
  }
  return text;
}

}  // namespace

int CsvTable::Column(std::string_view name) const {
  const auto found = std::find(header.begin(), header.end(), name);
  return found == header.end() ? -1 : static_cast<int>(found - header.begin());
}

Result<CsvTable> ParseCsv(std::string_view text, const std::string& name) {
  CsvTable table;
  CsvScanner scanner(WithoutByteOrderMark(text, 1), name, 1);
  for (;;) {
    scanner.SkipComments();
    if (scanner.AtEnd()) break;
    Result<CsvRow> row = scanner.Next();
    if (!row.ok()) return row.error();
    if (IsEmptyLine(*row)) continue;
    const bool first = table.header.empty();
    const Status checked =
        first ? CheckHeader(*row, name) : CheckWidth(*row, table.header, name);
    if (!checked.ok()) return checked.error();
    if (first) {
      table.header_line = row->line;
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
  const Status checked =
      CheckColumns(*table, path, table->header_line, columns);
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
  const Status checked = CheckHeader(**header, path);
  if (!checked.ok()) return checked.error();
  reader.table_.header_line = (*header)->line;
  reader.table_.header = std::move((*header)->fields);
  const Status complete =
      CheckColumns(reader.table_, path, reader.table_.header_line, columns);
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
    const std::string_view record = WithoutByteOrderMark(record_, first);
    if (BeginsWithComment(record)) continue;
    CsvScanner scanner(record, path_, first);
    if (scanner.AtEnd()) continue;  // Nothing but the byte order mark.
    Result<CsvRow> row = scanner.Next();
    if (!row.ok()) return row.error();
    if (!IsEmptyLine(*row)) return std::optional(*std::move(row));
  }
}

// The quotes of a comment mean nothing. Otherwise an odd number of them means
// that a line break is inside a field.
Result<bool> CsvReader::TakeRecord() {
  const int first_line = lines_.place().line;
  record_.clear();
  bool inside = false;
  do {
    const Result<bool> taken = lines_.Next();
    if (!taken.ok()) return taken.error();
    if (!*taken) break;
    const std::string& line = lines_.line();
    const std::string_view text = WithoutByteOrderMark(line, first_line);
    if (record_.empty() && BeginsWithComment(text)) {
      record_ = line;
      break;
    }
    if (std::count(line.begin(), line.end(), '"') % 2 == 1) inside = !inside;
    record_ += line;
  } while (inside && record_.size() < LineReader::kMaxLineBytes);
  return !record_.empty();
}

}  // namespace terra
