#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "benchmark/case_result.h"
#include "terrain/files/id_index.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// A results.csv that grows row by row and survives the death of its writer.
///
/// Threads: Append and IsDone from any; the others from one.
class ResultsFile {
 public:
  /// Opens or makes the file and locks it against other processes. A torn last
  /// line is cut off, rows without an answer are dropped.
  /// `cases`: in the order of the finished file; must outlive it.
  /// Errors: not writable, locked, not a results.csv, a row of another case.
  static Result<std::unique_ptr<ResultsFile>> Open(
      const std::string& path, const IdIndex& cases, int repeats,
      ResultColumns columns = ResultColumns::kUsual);

  ~ResultsFile();
  ResultsFile(const ResultsFile&) = delete;
  ResultsFile& operator=(const ResultsFile&) = delete;

  bool IsDone(std::size_t case_index, int repeat) const;
  std::int64_t num_done() const { return num_done_; }

  /// Adds a row with one write.
  Status Append(const CaseResult& result);

  /// Puts the rows into order of cases and repeats.
  Status Finish();

  /// Where a row stands; length 0 = there is none.
  struct Place {
    std::int64_t offset = 0;
    std::int64_t length = 0;
  };

 private:
  ResultsFile(std::string path, const IdIndex& cases, int repeats,
              ResultColumns columns);

  Status Lock();
  Status Recover();
  /// The rows by their place in the finished file.
  Result<std::vector<Place>> Scan(bool keep_unanswered);
  /// Place of a row in the finished file.
  Result<std::size_t> SlotOf(const CaseResult& result) const;

  const std::string path_;
  const IdIndex& cases_;
  const int repeats_;
  const ResultColumns columns_;
  std::vector<bool> done_;  ///< By slot: case index x repeats + repeat.
  std::int64_t num_done_ = 0;
  int lock_ = -1;
  int file_ = -1;
  std::mutex mutex_;
};

}  // namespace terra::benchmark
