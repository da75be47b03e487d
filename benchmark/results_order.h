#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "benchmark/case_list.h"
#include "benchmark/case_result.h"
#include "terrain/files/line_reader.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// What a results.csv is made of: rows in order of cases and repeats, and again
/// in order from each of these places on. A run that was started n times has at
/// most n parts.
using SortedParts = std::vector<LineReader::Place>;

/// More than any run has; each takes a pass through the cases.
inline constexpr std::size_t kMaxSortedParts = 64;

/// Finds the parts, the rows' order being that of the cases. Memory does not
/// depend on their number.
/// Errors: a row of another case or repeat, more than kMaxSortedParts parts.
Result<SortedParts> FindSortedParts(const std::string& path,
                                    const CaseIds& cases, int repeats);

/// A row and its place when all are there: case index x repeats + repeat.
struct OrderedRow {
  std::int64_t slot = 0;
  const CaseResult& result;
  const std::string& line;  ///< As it stands in the file.
};

/// Goes through all parts at once and calls `use` with the rows in order; of
/// rows with the same slot with the last.
Status MergeSortedParts(const std::string& path, const SortedParts& parts,
                        const CaseIds& cases, int repeats,
                        const std::function<void(const OrderedRow&)>& use);

}  // namespace terra::benchmark
