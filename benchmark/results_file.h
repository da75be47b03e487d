#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "benchmark/case_list.h"
#include "benchmark/case_result.h"
#include "benchmark/results_order.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// A results.csv that grows row by row and survives the death of its writer.
/// In memory is one bit per case and repeat.
///
/// Threads: Append and IsDone from any; the others from one.
class ResultsFile {
 public:
  /// Opens or makes the file and locks it against other processes. A torn last
  /// line is cut off, rows without an answer are dropped, the others put into
  /// order of the cases and repeats.
  /// Errors: not writable, locked, not a results.csv, a row of another case.
  static Result<std::unique_ptr<ResultsFile>> Open(
      const std::string& path, CaseIds cases, int repeats,
      ResultColumns columns = ResultColumns::kUsual);

  ~ResultsFile();
  ResultsFile(const ResultsFile&) = delete;
  ResultsFile& operator=(const ResultsFile&) = delete;

  /// Was it there when the file was opened?
  bool IsDone(std::size_t case_index, int repeat) const;
  std::int64_t num_done() const { return num_done_; }

  /// Adds a row with one write.
  Status Append(std::size_t case_index, const CaseResult& result);

  /// Puts the rows into order, unless they were added in it.
  Status Finish();

 private:
  ResultsFile(std::string path, CaseIds cases, int repeats,
              ResultColumns columns);

  Status Lock();
  Status Recover();
  /// Writes the wanted rows in order, in place of the file.
  Status Rewrite(const SortedParts& parts,
                 const std::function<bool(const OrderedRow&)>& wanted);
  /// Place of a row in the finished file.
  std::size_t SlotOf(std::size_t case_index, int repeat) const;

  const std::string path_;
  const CaseIds cases_;
  const int repeats_;
  const ResultColumns columns_;
  std::vector<bool> done_;  ///< By slot, up to the last row.
  std::int64_t num_done_ = 0;
  int lock_ = -1;
  int file_ = -1;
  std::mutex mutex_;
  std::size_t next_slot_ = 0;  ///< Rows from here on keep the order.
  bool ordered_ = true;
};

}  // namespace terra::benchmark
