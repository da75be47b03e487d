#include "verifier/journal_budget.h"

#include <algorithm>

namespace terra::verifier {

bool JournalBudget::Take(std::int64_t bytes, std::int64_t leaves,
                         std::int64_t now_us) {
  Refill(now_us);
  if (bytes > left_ - leaves) return false;
  left_ -= bytes;
  return true;
}

// What is left of a microsecond's share is kept: the clock is moved on by whole
// bytes only.
void JournalBudget::Refill(std::int64_t now_us) {
  constexpr std::int64_t kSecond = 1'000'000;
  if (now_us <= now_us_) return;
  // In unsigned arithmetic, since the first time is infinitely long ago.
  const std::uint64_t passed =
      static_cast<std::uint64_t>(now_us) - static_cast<std::uint64_t>(now_us_);
  const std::int64_t missing = limits_.burst - left_;
  const std::int64_t full_after =
      (missing * kSecond + limits_.bytes_per_s - 1) / limits_.bytes_per_s;
  if (passed >= static_cast<std::uint64_t>(full_after)) {
    left_ = limits_.burst;
    now_us_ = now_us;
    return;
  }
  const std::int64_t gained =
      static_cast<std::int64_t>(passed) * limits_.bytes_per_s / kSecond;
  left_ += gained;
  now_us_ += (gained * kSecond + limits_.bytes_per_s - 1) / limits_.bytes_per_s;
  now_us_ = std::min(now_us_, now_us);
}

}  // namespace terra::verifier
