#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/logger/recorded_run.h"

namespace terra::logger {

/// Flips bits of the messages of a log and asks the audit whether it notices.
///
/// The log has no seals and says each thing once, so that neither a checksum
/// nor a repetition gives the change away: only the decisions can.
class FlipCheck {
 public:
  explicit FlipCheck(const Messages& run);

  /// Where the log's messages are, by byte.
  struct Place {
    std::size_t message = 0;
    std::size_t byte = 0;
  };
  const std::vector<Place>& places() const { return places_; }

  /// Returns whether the audit notices a flip, or else whether the bit decides
  /// nothing; what is wrong if neither.
  std::optional<std::string> WhatIsWrong(Place place, int bit);

  std::int64_t noticed() const { return noticed_; }
  std::int64_t irrelevant() const { return irrelevant_; }

 private:
  bool Irrelevant(Place place, const bus::RawMessage& changed);
  bool NothingFollowsFrom(std::size_t message);

  Messages messages_;
  std::vector<Place> places_;
  std::int64_t made_again_ = 0;
  // By message, once asked for.
  std::vector<std::optional<bool>> nothing_follows_;
  std::int64_t noticed_ = 0;
  std::int64_t irrelevant_ = 0;
};

}  // namespace terra::logger
