#pragma once

#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>

#include "terrain/result.h"

namespace terra {

/// Opens a regular file. Errors: not there, not readable, not a file.
Result<std::ifstream> OpenToRead(const std::string& path);

/// Reads a regular file into memory. Errors: not there, not readable, not a
/// file, larger than `max_bytes`.
Result<std::string> ReadWholeFile(const std::string& path,
                                  std::size_t max_bytes);

/// Writes a file so that a reader sees the old content or the new, never a part
/// of it: to a temporary name beside it, then renamed.
Status WriteWholeFile(const std::string& path, std::string_view content);

}  // namespace terra
