#include "terrain/files/file_watch.h"

#include <algorithm>

#include <sys/stat.h>

namespace terra {
namespace {

thread_local OpenedFiles* innermost = nullptr;

}  // namespace

FileStamp StampOf(const std::string& path) {
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0) return {};
  return {static_cast<std::int64_t>(file.st_dev),
          static_cast<std::int64_t>(file.st_ino),
          static_cast<std::int64_t>(file.st_size),
          static_cast<std::int64_t>(file.st_mtim.tv_sec),
          static_cast<std::int64_t>(file.st_mtim.tv_nsec),
          static_cast<std::int64_t>(file.st_ctim.tv_sec),
          static_cast<std::int64_t>(file.st_ctim.tv_nsec)};
}

OpenedFiles::OpenedFiles() : outer_(innermost) {
  innermost = this;
}

OpenedFiles::~OpenedFiles() {
  innermost = outer_;
}

void OpenedFiles::Note(const std::string& path) {
  for (OpenedFiles* notes = innermost; notes != nullptr;
       notes = notes->outer_) {
    const bool known = std::any_of(notes->list_.begin(), notes->list_.end(),
                                   [&](const auto& noted) {
                                     return noted.first == path;
                                   });
    if (!known) notes->list_.emplace_back(path, StampOf(path));
  }
}

OpenedFiles::List FileWatch::Now() const {
  OpenedFiles::List now = read_from_;
  for (auto& [path, stamp] : now) stamp = StampOf(path);
  return now;
}

Status FileWatch::Attempt() {
  OpenedFiles opened;
  Status status = read_();
  read_from_ = opened.Take();
  last_look_ = read_from_;
  unrest_ = 0;
  again_ = !status.ok() && status.error().code == ErrorCode::kUnavailable;
  return status;
}

Status FileWatch::Begin() {
  return Attempt();
}

std::optional<Status> FileWatch::ReadIfChanged() {
  if (Now() == read_from_ && !again_) return std::nullopt;
  return Attempt();
}

std::optional<Status> FileWatch::Look() {
  OpenedFiles::List now = Now();
  const bool at_rest = now == last_look_;
  last_look_ = std::move(now);
  if (last_look_ == read_from_ && !again_) {
    unrest_ = 0;
    return std::nullopt;
  }
  if (!at_rest && ++unrest_ < kMostUnrest) return std::nullopt;
  Status status = Attempt();
  if (status.ok() && Now() != read_from_) {
    again_ = true;
    return Error{ErrorCode::kUnavailable,
                 read_from_.front().first +
                     ": it, or a file that it names, changed while it was "
                     "read"};
  }
  return status;
}

}  // namespace terra
