#include "terrain/files/whole_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "terrain/files/file_watch.h"

namespace terra {
namespace fs = std::filesystem;

Result<std::ifstream> OpenToRead(const std::string& path) {
  OpenedFiles::Note(path);
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (!fs::exists(status)) {
    return Error{ErrorCode::kNotFound, path + ": there is no such file"};
  }
  if (!fs::is_regular_file(status)) {
    return Error{ErrorCode::kInvalid, path + ": is not a regular file"};
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return Error{ErrorCode::kUnavailable,
                 path + ": cannot be opened: " + std::strerror(errno)};
  }
  return file;
}

Result<std::string> ReadWholeFile(const std::string& path,
                                  std::size_t max_bytes) {
  Result<std::ifstream> opened = OpenToRead(path);
  if (!opened.ok()) return opened.error();
  std::ifstream file = *std::move(opened);
  std::error_code failure;
  const std::uintmax_t size = fs::file_size(path, failure);
  if (failure || size > max_bytes) {
    return Error{ErrorCode::kUnsupported,
                 path + ": larger than " + std::to_string(max_bytes) +
                     " bytes, the limit for this kind of file"};
  }
  std::string content(static_cast<std::size_t>(size), '\0');
  file.read(content.data(), static_cast<std::streamsize>(content.size()));
  content.resize(static_cast<std::size_t>(file.gcount()));
  if (file.bad()) {
    return Error{ErrorCode::kUnavailable, path + ": cannot be read"};
  }
  return content;
}

}  // namespace terra
