#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>

#include "verifier/gate_messages.h"

namespace terra::verifier {

/// Which advice has had its verdict. Advice is the same where all that names it
/// and all that it says are the same, so a message of somebody else's that
/// copies a session and an attempt number is another one. What was not repeated
/// for longest is forgotten first, so that a flood of new advice cannot push
/// out advice that is still being repeated.
class JudgedAdvice {
 public:
  explicit JudgedAdvice(std::size_t capacity) : capacity_(capacity) {}

  /// Returns true the first time, false for a repeat.
  bool Add(const AdviceEvent& event);
  /// Returns whether it would be a repeat.
  bool Has(const AdviceEvent& event) const;
  /// Returns whether nothing was ever forgotten.
  bool remembers_all() const { return !forgot_; }

 private:
  // (request, map, baseline, session, attempt, candidate, digest of the rest)
  using Key = std::tuple<std::int64_t, std::int64_t, std::int64_t, std::int64_t,
                         std::int64_t, std::int32_t, std::int64_t>;

  static Key KeyOf(const AdviceEvent& event);

  std::size_t capacity_;
  bool forgot_ = false;
  std::int64_t heard_ = 0;
  std::map<std::int64_t, Key>
      by_age_;  // when last heard, the longest ago first
  std::map<Key, std::int64_t> known_;
};

}  // namespace terra::verifier
