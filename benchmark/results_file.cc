#include "benchmark/results_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include <sys/file.h>

#include "output/output_file.h"

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

}  // namespace

ResultsFile::ResultsFile(std::string path, CaseIds cases, int repeats,
                         ResultColumns columns)
    : path_(std::move(path)),
      cases_(std::move(cases)),
      repeats_(repeats),
      columns_(columns) {}

ResultsFile::~ResultsFile() {
  if (file_ >= 0) ::close(file_);
  if (lock_ >= 0) ::close(lock_);
}

Result<std::unique_ptr<ResultsFile>> ResultsFile::Open(const std::string& path,
                                                       CaseIds cases,
                                                       int repeats,
                                                       ResultColumns columns) {
  std::unique_ptr<ResultsFile> file(
      new ResultsFile(path, std::move(cases), repeats, columns));
  const Status locked = file->Lock();
  if (!locked.ok()) return locked.error();
  const Status recovered = file->Recover();
  if (!recovered.ok()) return recovered.error();
  file->next_slot_ = file->done_.size();
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

Status ResultsFile::Rewrite(
    const SortedParts& parts,
    const std::function<bool(const OrderedRow&)>& wanted) {
  Result<OutputFile> to = OutputFile::Create(path_);
  if (!to.ok()) return to.error();
  to->Write(ResultsHeader(columns_));
  const Status merged = MergeSortedParts(path_, parts, cases_, repeats_,
                                         [&](const OrderedRow& row) {
                                           if (wanted(row)) to->Write(row.line);
                                         });
  if (!merged.ok()) return merged;
  return to->Finish();
}

Status ResultsFile::Recover() {
  if (fs::exists(path_)) {
    const Status cut = CutTornLine(path_);
    if (!cut.ok()) return cut.error();
  }
  SortedParts parts;
  if (fs::exists(path_) && fs::file_size(path_) > 0) {
    Result<SortedParts> found = FindSortedParts(path_, cases_, repeats_);
    if (!found.ok()) return found.error();
    parts = *std::move(found);
  }
  return Rewrite(parts, [&](const OrderedRow& row) {
    if (row.result.kind == AttemptKind::kNoAnswer) return false;
    done_.resize(static_cast<std::size_t>(row.slot));
    done_.push_back(true);
    ++num_done_;
    return true;
  });
}

Status ResultsFile::Append(std::size_t case_index, const CaseResult& result) {
  const std::string line = ResultLine(result, columns_);
  const std::size_t slot = SlotOf(case_index, result.repeat);
  const std::scoped_lock lock(mutex_);
  ordered_ = ordered_ && slot >= next_slot_;
  next_slot_ = slot + 1;
  if (::write(file_, line.data(), line.size()) ==
      static_cast<ssize_t>(line.size())) {
    return Done{};
  }
  return SystemError(path_, "cannot be written");
}

Status ResultsFile::Finish() {
  if (ordered_) return Done{};
  const Result<SortedParts> parts = FindSortedParts(path_, cases_, repeats_);
  if (!parts.ok()) return parts.error();
  return Rewrite(*parts, [](const OrderedRow&) {
    return true;
  });
}

bool ResultsFile::IsDone(std::size_t case_index, int repeat) const {
  const std::size_t slot = SlotOf(case_index, repeat);
  return slot < done_.size() && done_[slot];
}

std::size_t ResultsFile::SlotOf(std::size_t case_index, int repeat) const {
  return case_index * static_cast<std::size_t>(repeats_) +
         static_cast<std::size_t>(repeat);
}

}  // namespace terra::benchmark
