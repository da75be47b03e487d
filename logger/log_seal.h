#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "terra_msg/log_mark_t.hpp"

#include "logger/log_event.h"
#include "logger/log_reader.h"

struct XXH3_state_s;

namespace terra::logger {

/// How our logs find changed bytes, which the LCM format cannot: marks. Each
/// mark (log_mark_t on TERRA_LOG, an event like any other for every player)
/// seals the bytes since the end of the mark before, and itself:
///
///   checksum = XXH3-64 (seed 0) of [first_byte, first_byte + num_bytes) of the
///              file followed by the bytes of the mark's own event with the
///              eight bytes of its checksum field 0.
///
/// So every byte of a closed file is sealed exactly once, and a file whose last
/// event is not a KIND_END mark was not closed in order.
inline constexpr std::int32_t kLogFormatVersion = 1;

/// A running XXH3-64 (Collet, xxHash).
class RunningChecksum {
 public:
  RunningChecksum();
  void Reset();
  void Add(std::span<const std::uint8_t> bytes);
  std::int64_t Value() const;

 private:
  struct Free {
    void operator()(XXH3_state_s* state) const;
  };
  std::unique_ptr<XXH3_state_s, Free> state_;
};

/// Appends a mark as an event, with the checksum that `covered` (the bytes
/// since the last mark) and the mark itself make, and begins to cover anew.
/// `place` gives number, time and channel; the mark's other fields are given.
void AppendMark(std::vector<std::uint8_t>& bytes, LogEvent place,
                terra_msg::log_mark_t mark, RunningChecksum& covered);

/// Follows the events of a log, in order, and says where its bytes are not what
/// was written. Any marks are safe.
class SealChecker {
 public:
  static constexpr std::size_t kMaxBroken = 1'000;

  /// Some bytes that no good seal covers.
  struct Broken {
    std::int64_t offset = 0;
    std::int64_t bytes = 0;
    std::string reason;
  };

  /// Takes the next event; returns its mark if it is a well-formed one.
  std::optional<terra_msg::log_mark_t> Take(const LogReader::Item& item);
  /// To be called after the last event, with the size of the file.
  void Finish(std::int64_t file_size);

  /// Marks were found: this is one of our logs.
  bool sealed() const { return sealed_; }
  std::int64_t good() const { return good_; }
  /// The first kMaxBroken; all are counted.
  const std::vector<Broken>& broken() const { return broken_; }
  std::int64_t num_broken() const { return num_broken_; }
  /// Events that the logger itself said it lost.
  std::int64_t lost() const { return lost_; }
  /// Bytes after the last mark: true but without a seal, or cut.
  std::int64_t unsealed_bytes() const { return unsealed_bytes_; }
  /// The last event is a good mark of KIND_END.
  bool closed() const { return closed_; }
  /// The first good mark of KIND_HEADER.
  const std::optional<terra_msg::log_mark_t>& header() const { return header_; }

 private:
  std::string Check(const LogReader::Item& item,
                    const terra_msg::log_mark_t& mark);
  void Break(std::int64_t offset, std::int64_t bytes, std::string reason);

  RunningChecksum covered_;
  std::int64_t covered_from_ = 0;
  std::int64_t covered_events_ = 0;
  std::int64_t next_number_ = 0;
  std::int64_t end_ = 0;
  bool sealed_ = false;
  std::int64_t good_ = 0;
  std::int64_t num_broken_ = 0;
  std::vector<Broken> broken_;
  std::int64_t lost_ = 0;
  std::int64_t unsealed_bytes_ = 0;
  bool closed_ = false;
  std::optional<terra_msg::log_mark_t> header_;
};

}  // namespace terra::logger
