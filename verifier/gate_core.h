#pragma once

#include <cstdint>

#include "terrain/cell.h"
#include "verifier/gate.h"

/// The gate's core by its names and by its digest, as the journal has them.
///
/// The core is all that decides: the request in force, the map, the baseline
/// that is held, what is deployed, the robot's place along it, and the number
/// of the last decision. It is not the memories (which ids were replaced, which
/// advice was judged): what they said of an event is written down with the
/// event. Names of others, which the gate only repeats, decide nothing.
namespace terra::verifier {

/// Tells two cores apart; equal cores have equal digests on any machine.
std::int64_t CoreDigest(const Gate& gate);

/// What names the parts of a core. Whoever holds the messages with these names
/// can make the same core of them, and its digest proves it.
struct CoreNames {
  std::int64_t request_id = 0;
  bool request_cancelled = false;
  std::int64_t answered_by = 0;
  std::int64_t map_id = 0;
  std::int64_t baseline_digest = 0;
  std::int64_t baseline_session = 0;
  std::int64_t route_seq = 0;
  Cell place_cell;
  int place = -1;
  bool on_route = true;
  std::int64_t decisions = 0;
  std::int64_t digest = 0;

  friend bool operator==(const CoreNames&, const CoreNames&) = default;
};

CoreNames NamesOf(const Gate& gate);

}  // namespace terra::verifier
