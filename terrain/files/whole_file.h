#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "terrain/result.h"

namespace terra {

/// Reads a regular file into memory. Errors: not there, not readable, not a
/// file, larger than `max_bytes`.
Result<std::string> ReadWholeFile(const std::string& path,
                                  std::size_t max_bytes);

/// Writes a file so that a reader sees the old content or the new, never a part
/// of it: to a temporary name beside it, then renamed.
Status WriteWholeFile(const std::string& path, std::string_view content);

}  // namespace terra
