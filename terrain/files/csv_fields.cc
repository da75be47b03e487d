#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "terrain/files/ascii_case.h"
#include "terrain/files/csv.h"

namespace terra {
namespace {

// Would it not be read back as it is? At the start of a text a byte order mark,
// at the start of a line a # would not.
bool NeedsQuotes(const std::string& field, bool first) {
  const auto is_blank = [](char c) {
    return c == ' ' || c == '\t';
  };
  return field.find_first_of(",\"\r\n") != std::string::npos ||
         field.starts_with(kCsvByteOrderMark) ||
         (first && field.starts_with('#')) ||
         (!field.empty() &&
          (is_blank(field.front()) || is_blank(field.back())));
}

bool IsInfinity(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  return EqualsInAnyCase(text, "inf") || EqualsInAnyCase(text, "infinity");
}

// What to write instead, where that is plain.
std::string Advice(std::string_view text) {
  return std::count(text.begin(), text.end(), ',') == 1
             ? " (numbers have a point: 1.5)"
             : "";
}

}  // namespace

std::string CsvLine(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) line += ',';
    if (!NeedsQuotes(fields[i], i == 0)) {
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
  if (IsInfinity(text)) return std::numeric_limits<double>::infinity();
  if (parsed.ec != std::errc() || parsed.ptr != end || !std::isfinite(value)) {
    return Error{ErrorCode::kInvalid,
                 "'" + std::string(text) + "' is not a number" + Advice(text)};
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
