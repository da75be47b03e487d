#pragma once

#include <cstdint>
#include <string>

namespace terra::benchmark {

/// By what cases of two runs are put together: a 64-bit hash of the id, because
/// there may be many (of ten million ids two have the same one in 400,000).
std::uint64_t CaseKey(const std::string& case_id);

/// One part of the cases, by their keys. What must keep something of each case
/// works with parts that fit into memory.
struct CasePart {
  std::uint64_t index = 0;
  std::uint64_t count = 1;

  bool Takes(std::uint64_t key) const {
    return count == 1 || key % count == index;
  }
};

/// Cases whose figures are kept at a time: some 250 MB of them.
inline constexpr std::int64_t kMaxCasesKept = 4'000'000;

/// Into how many parts so many cases are divided. Pre: `at_once` > 0.
inline std::uint64_t NumParts(std::int64_t cases,
                              std::int64_t at_once = kMaxCasesKept) {
  return cases <= at_once
             ? 1
             : static_cast<std::uint64_t>((cases + at_once - 1) / at_once);
}

}  // namespace terra::benchmark
