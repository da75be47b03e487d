#include "logger/log_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <tuple>
#include <utility>

#include <sys/file.h>

#include "base/utc.h"
#include "bus/messages.h"
#include "logger/log_channels.h"
#include "logger/log_event.h"

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

constexpr std::string_view kRecordingLine = "recording ";
// A header may hold anything; so many recordings are made by nobody.
constexpr std::int64_t kMaxRecording = 1'000'000'000'000;
// A header mark is shorter.
constexpr std::size_t kMaxHeaderBytes = 16'384;

// The number in a header's recording line; 0 where there is none.
std::int64_t RecordingIn(std::string_view header) {
  std::int64_t recording = 0;
  while (!header.empty()) {
    const std::string_view line = header.substr(0, header.find('\n'));
    header.remove_prefix(std::min(header.size(), line.size() + 1));
    if (!line.starts_with(kRecordingLine)) continue;
    const std::string_view number = line.substr(kRecordingLine.size());
    std::from_chars(number.data(), number.data() + number.size(), recording);
  }
  return std::clamp<std::int64_t>(recording, 0, kMaxRecording);
}

// The beginning of a regular file, never of what a link names.
std::vector<std::uint8_t> BeginningOf(const std::string& path) {
  const int fd =
      open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (fd < 0) return {};
  std::vector<std::uint8_t> bytes(kMaxHeaderBytes);
  const ssize_t got = read(fd, bytes.data(), bytes.size());
  close(fd);
  bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(0, got)));
  return bytes;
}

std::optional<StoredPart> ReadPart(
    const std::filesystem::directory_entry& entry) {
  std::error_code error;
  if (!IsPartName(entry.path().filename().string()) ||
      entry.symlink_status(error).type() !=
          std::filesystem::file_type::regular) {
    return std::nullopt;
  }
  StoredPart part;
  part.path = entry.path().string();
  part.bytes = static_cast<std::int64_t>(entry.file_size(error));
  const std::vector<std::uint8_t> bytes = BeginningOf(part.path);
  const ParsedLogEvent first = ParseLogEvent(bytes);
  if (error || !first.complete ||
      ChannelOf(first.event.channel) != bus::Channel::kLog) {
    return std::nullopt;
  }
  const auto header = bus::Decode<terra_msg::log_mark_t>(first.event.data);
  if (!header || header->mark_kind != terra_msg::log_mark_t::KIND_HEADER) {
    return std::nullopt;
  }
  part.mark_channel = first.event.channel;
  part.recording = RecordingIn(header->mark_text);
  part.session = header->session;
  part.number = header->part;
  return part;
}

// Parts from before recordings were counted are the oldest; among those the
// time in their names is all there is. Sessions only keep two recordings apart
// that were begun at once.
auto Age(const StoredPart& part) {
  const std::string name = std::filesystem::path(part.path).filename().string();
  return std::tuple(
      part.recording,
      part.recording == 0 ? name.substr(0, kNameForm.find('.')) : std::string(),
      part.session, part.number);
}

}  // namespace

bool IsBeingWritten(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (fd < 0) return false;
  const bool locked = flock(fd, LOCK_SH | LOCK_NB) != 0;
  close(fd);
  return locked;
}

std::string RecordingLine(std::int64_t recording) {
  return std::string(kRecordingLine) + std::to_string(recording);
}

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
  std::array<char, 32> rest{};
  std::snprintf(rest.data(), rest.size(), "-%08x.%03d",
                static_cast<unsigned>(session), part);
  return (std::filesystem::path(path_) /
          ("terra-" + FormatUtc(begin_us / 1'000'000, "%Y%m%dT%H%M%SZ") +
           rest.data() + std::string(kExtension)))
      .string();
}

std::vector<StoredPart> LogFolder::Parts() const {
  std::vector<StoredPart> parts;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(path_, error)) {
    std::optional<StoredPart> part = ReadPart(entry);
    if (part) parts.push_back(*std::move(part));
  }
  std::sort(parts.begin(), parts.end(),
            [](const StoredPart& a, const StoredPart& b) {
              return Age(a) < Age(b);
            });
  return parts;
}

int LogFolder::ShrinkTo(std::int64_t bytes) const {
  const std::vector<StoredPart> parts = Parts();
  std::int64_t total = 0;
  for (const StoredPart& part : parts) total += part.bytes;
  int deleted = 0;
  std::error_code error;
  for (const StoredPart& part : parts) {
    if (total <= bytes) break;
    if (IsBeingWritten(part.path)) continue;
    if (!std::filesystem::remove(part.path, error)) continue;
    total -= part.bytes;
    ++deleted;
  }
  return deleted;
}

}  // namespace terra::logger
