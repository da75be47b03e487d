#pragma once

#include <cstddef>
#include <fstream>
#include <string>

#include "terrain/result.h"

namespace terra {

/// Opens a regular file. Errors: not there, not readable, not a file.
Result<std::ifstream> OpenToRead(const std::string& path);

/// Reads a regular file into memory. Errors: not there, not readable, not a
/// file, larger than `max_bytes`.
Result<std::string> ReadWholeFile(const std::string& path,
                                  std::size_t max_bytes);

}  // namespace terra
