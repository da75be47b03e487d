#include "benchmark/results_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

#include <sys/file.h>

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

Error SystemError(const std::string& path, const std::string& what) {
  return Error{ErrorCode::kUnavailable,
               path + ": " + what + ": " + std::strerror(errno)};
}

// Cuts off what follows the last line feed: a row that was being written.
Status CutTornLine(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::streamoff size = file.tellg();
  const std::streamoff whole = size;
  for (char last = 0; size > 0; --size) {
    file.seekg(size - 1);
    file.get(last);
    if (last == '\n') break;
  }
  if (size == whole) return Done{};
  std::error_code failed;
  fs::resize_file(path, static_cast<std::uintmax_t>(size), failed);
  if (failed) {
    return Error{ErrorCode::kUnavailable, path + ": " + failed.message()};
  }
  return Done{};
}

// Where the rows of a file stand, one per line after the header.
std::vector<ResultsFile::Place> RowPlaces(const std::string& path) {
  std::vector<ResultsFile::Place> places;
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::getline(file, line);
  std::int64_t offset = static_cast<std::int64_t>(line.size()) + 1;
  while (std::getline(file, line)) {
    const auto length = static_cast<std::int64_t>(line.size()) + 1;
    places.push_back({offset, length});
    offset += length;
  }
  return places;
}

// Copies rows into a new file, in this order, and puts it in place of the old.
Status RewriteRows(const std::string& path,
                   const std::vector<ResultsFile::Place>& places,
                   ResultColumns columns) {
  const std::string temporary = path + ".part";
  {
    std::ifstream from(path, std::ios::binary);
    std::ofstream to(temporary, std::ios::binary | std::ios::trunc);
    to << ResultsHeader(columns);
    std::string row;
    for (const ResultsFile::Place& place : places) {
      if (place.length == 0) continue;
      row.resize(static_cast<std::size_t>(place.length));
      from.seekg(place.offset);
      from.read(row.data(), place.length);
      if (!from) return SystemError(path, "cannot be read");
      to << row;
    }
    if (!to.flush()) return SystemError(temporary, "cannot be written");
  }
  if (std::rename(temporary.c_str(), path.c_str()) != 0) {
    return SystemError(path, "cannot be replaced");
  }
  return Done{};
}

}  // namespace

ResultsFile::ResultsFile(std::string path, const IdIndex& cases, int repeats,
                         ResultColumns columns)
    : path_(std::move(path)),
      cases_(cases),
      repeats_(repeats),
      columns_(columns),
      done_(cases.size() * static_cast<std::size_t>(repeats)) {}

ResultsFile::~ResultsFile() {
  if (file_ >= 0) ::close(file_);
  if (lock_ >= 0) ::close(lock_);
}

Result<std::unique_ptr<ResultsFile>> ResultsFile::Open(const std::string& path,
                                                       const IdIndex& cases,
                                                       int repeats,
                                                       ResultColumns columns) {
  std::unique_ptr<ResultsFile> file(
      new ResultsFile(path, cases, repeats, columns));
  const Status locked = file->Lock();
  if (!locked.ok()) return locked.error();
  const Status recovered = file->Recover();
  if (!recovered.ok()) return recovered.error();
  file->file_ =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file->file_ < 0) return SystemError(path, "cannot be opened");
  return file;
}

Status ResultsFile::Lock() {
  const std::string path = path_ + ".lock";
  lock_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) return SystemError(path, "cannot be opened");
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return Done{};
  return Error{ErrorCode::kUnavailable,
               path_ + ": another process is writing these results"};
}

Result<std::size_t> ResultsFile::SlotOf(const CaseResult& result) const {
  const std::optional<std::size_t> found = cases_.Find(result.case_id);
  if (!found || result.repeat < 0 || result.repeat >= repeats_) {
    return Error{ErrorCode::kInvalid,
                 path_ + ": case '" + result.case_id + "' repeat " +
                     std::to_string(result.repeat) + " is not of this run"};
  }
  return *found * static_cast<std::size_t>(repeats_) +
         static_cast<std::size_t>(result.repeat);
}

Result<std::vector<ResultsFile::Place>> ResultsFile::Scan(
    bool keep_unanswered) {
  const std::vector<Place> rows = RowPlaces(path_);
  std::vector<Place> by_slot(done_.size());
  std::optional<Error> failure;
  std::size_t row = 0;
  const Status read = ReadResults(path_, [&](const CaseResult& result) {
    const Result<std::size_t> slot = SlotOf(result);
    const Place place = rows.at(row++);
    if (!slot.ok()) {
      failure = slot.error();
    } else if (keep_unanswered || result.kind != AttemptKind::kNoAnswer) {
      by_slot[*slot] = place;
    }
  });
  if (!read.ok()) return read.error();
  if (failure) return *failure;
  return by_slot;
}

Status ResultsFile::Recover() {
  if (fs::exists(path_)) {
    const Status cut = CutTornLine(path_);
    if (!cut.ok()) return cut.error();
  }
  if (!fs::exists(path_) || fs::file_size(path_) == 0) {
    return RewriteRows(path_, {}, columns_);
  }
  const Result<std::vector<Place>> by_slot = Scan(false);
  if (!by_slot.ok()) return by_slot.error();
  for (std::size_t slot = 0; slot < by_slot->size(); ++slot) {
    if ((*by_slot)[slot].length == 0) continue;
    done_[slot] = true;
    ++num_done_;
  }
  return RewriteRows(path_, *by_slot, columns_);
}

Status ResultsFile::Append(const CaseResult& result) {
  const std::string line = ResultLine(result, columns_);
  const std::scoped_lock lock(mutex_);
  if (::write(file_, line.data(), line.size()) ==
      static_cast<ssize_t>(line.size())) {
    return Done{};
  }
  return SystemError(path_, "cannot be written");
}

Status ResultsFile::Finish() {
  const Result<std::vector<Place>> by_slot = Scan(true);
  if (!by_slot.ok()) return by_slot.error();
  return RewriteRows(path_, *by_slot, columns_);
}

bool ResultsFile::IsDone(std::size_t case_index, int repeat) const {
  return done_[case_index * static_cast<std::size_t>(repeats_) +
               static_cast<std::size_t>(repeat)];
}

}  // namespace terra::benchmark
