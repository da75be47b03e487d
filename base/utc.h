#pragma once

#include <cstdint>
#include <string>

namespace terra {

/// A time as strftime formats it, in UTC. `unix_seconds` since 1970. Empty for
/// a year that the system cannot name, and for more than 63 bytes.
std::string FormatUtc(std::int64_t unix_seconds, const char* format);

/// "2026-01-31T12:00:00Z", by the system's clock.
std::string UtcNow();

}  // namespace terra
