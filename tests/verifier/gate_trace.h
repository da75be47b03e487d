#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <variant>
#include <vector>

#include "tests/verifier/exact_oracle.h"
#include "verifier/gate.h"

namespace terra::verifier {

using Event =
    std::variant<MapEvent, RequestEvent, BaselineEvent, AdviceEvent, PoseEvent>;

/// The session of the gate that PlayTrace feeds.
inline constexpr GateOptions kTraceOptions = {.margin = 0, .session = 4711};

Decisions Feed(Gate& gate, const Event& event);

/// What somebody beside the gate knows, from the events it was fed and the
/// DEPLOYED messages it sent.
struct Observed {
  std::shared_ptr<const TerrainMap> map;
  std::int64_t map_id = 0;
  Deployed deployed;
  /// The last baseline for this request and map, or for this request and an
  /// earlier map; its exact check on this map.
  std::optional<BaselineEvent> baseline;
  OracleCheck baseline_check;

  /// Dense cells of the deployed route; index of the last one the robot was
  /// seen near; whether it was near any when last seen.
  std::vector<Cell> cells;
  std::size_t place = 0;
  bool on_route = true;

  bool cancelled() const { return deployed.cause == Cause::kCancelled; }
  bool baseline_valid() const { return baseline && baseline_check.feasible(); }
};

/// One event, what the gate made of it, and the state around it.
struct Turn {
  Event event;
  Decisions decisions;
  Observed before;
  Observed after;
  /// Advice only: whether the same (key, session, attempt, candidate) had its
  /// verdict before.
  bool repeat = false;
};

/// Makes events out of random numbers and feeds them to a gate: maps, requests,
/// baselines good and bad, poses, advice of every kind with keys and anchors in
/// force, replaced and made up, and repetitions of all of them.
std::vector<Turn> PlayTrace(std::span<const std::uint32_t> random);

}  // namespace terra::verifier
