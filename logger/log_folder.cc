#include "logger/log_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <system_error>
#include <vector>

#include <sys/file.h>

namespace terra::logger {
namespace {

// 9 stands for a digit, f for a hexadecimal one; a part number may be longer.
constexpr std::string_view kNameForm = "terra-99999999T999999Z-ffffffff.999";
constexpr std::string_view kExtension = ".lcmlog";

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

bool Fits(char c, char form) {
  if (form == '9') return IsDigit(c);
  if (form == 'f') return IsDigit(c) || (c >= 'a' && c <= 'f');
  return c == form;
}

// A logger holds a lock on the part that it writes.
bool IsBeingWritten(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool locked = flock(fd, LOCK_SH | LOCK_NB) != 0;
  close(fd);
  return locked;
}

}  // namespace

bool IsPartName(std::string_view name) {
  if (!name.ends_with(kExtension)) return false;
  name.remove_suffix(kExtension.size());
  return name.size() >= kNameForm.size() &&
         std::equal(kNameForm.begin(), kNameForm.end(), name.begin(),
                    [](char form, char c) {
                      return Fits(c, form);
                    }) &&
         std::all_of(name.begin() + kNameForm.size(), name.end(), IsDigit);
}

Result<LogFolder> LogFolder::Open(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error && !std::filesystem::is_directory(path)) {
    return Error{ErrorCode::kUnavailable,
                 "cannot make the log folder " + path + ": " + error.message()};
  }
  return LogFolder(path);
}

std::string LogFolder::PartPath(std::int64_t begin_us, std::int64_t session,
                                int part) const {
  const std::time_t seconds = begin_us / 1'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> time{};
  std::strftime(time.data(), time.size(), "%Y%m%dT%H%M%SZ", &utc);
  std::array<char, 32> rest{};
  std::snprintf(rest.data(), rest.size(), "-%08x.%03d",
                static_cast<unsigned>(session), part);
  return (std::filesystem::path(path_) /
          ("terra-" + std::string(time.data()) + rest.data() +
           std::string(kExtension)))
      .string();
}

int LogFolder::ShrinkTo(std::int64_t bytes) const {
  struct Part {
    std::string path;
    std::int64_t bytes;
  };
  std::vector<Part> parts;
  std::int64_t total = 0;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(path_, error)) {
    if (!IsPartName(entry.path().filename().string())) continue;
    const auto size = static_cast<std::int64_t>(entry.file_size(error));
    if (error) continue;
    parts.push_back({entry.path().string(), size});
    total += size;
  }
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return std::pair(a.path.size(), a.path) < std::pair(b.path.size(), b.path);
  });
  int deleted = 0;
  for (const Part& part : parts) {
    if (total <= bytes) break;
    if (IsBeingWritten(part.path)) continue;
    if (!std::filesystem::remove(part.path, error)) continue;
    total -= part.bytes;
    ++deleted;
  }
  return deleted;
}

}  // namespace terra::logger
