#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "terrain/files/csv.h"

namespace terra {

std::string CsvLine(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) line += ',';
    // At the start of a text a byte order mark would not be read back.
    if (fields[i].find_first_of(",\"\r\n") == std::string::npos &&
        !fields[i].starts_with(kCsvByteOrderMark)) {
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
