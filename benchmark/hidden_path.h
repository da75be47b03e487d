#pragma once

#include <filesystem>

namespace terra::benchmark {

/// Is a file or folder hidden (a leading dot)? What file managers and archives
/// leave behind is: .DS_Store, ._NAME, .Trash-1000.
inline bool IsHidden(const std::filesystem::path& path) {
  return path.filename().string().starts_with('.');
}

}  // namespace terra::benchmark
