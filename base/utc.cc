#include "base/utc.h"

#include <array>
#include <ctime>

namespace terra {

std::string FormatUtc(std::int64_t unix_seconds, const char* format) {
  const std::time_t seconds = unix_seconds;
  std::tm utc{};
  if (gmtime_r(&seconds, &utc) == nullptr) return "";
  std::array<char, 64> text{};
  const std::size_t size =
      std::strftime(text.data(), text.size(), format, &utc);
  return std::string(text.data(), size);
}

std::string UtcNow() {
  return FormatUtc(std::time(nullptr), "%Y-%m-%dT%H:%M:%SZ");
}

}  // namespace terra
