#include "verifier/gate_core.h"

#include <bit>
#include <type_traits>
#include <vector>

#include "terrain/digest.h"

namespace terra::verifier {
namespace {

using Words = std::vector<std::int64_t>;

std::int64_t DigestOf(const Route& route) {
  static_assert(std::has_unique_object_representations_v<Cell>);
  return BytesDigest({reinterpret_cast<const std::uint8_t*>(route.data()),
                      route.size() * sizeof(Cell)});
}

void Add(Words& words, Cell cell) {
  words.push_back(cell.x);
  words.push_back(cell.y);
}

void Add(Words& words, double value) {
  words.push_back(std::bit_cast<std::int64_t>(value));
}

void Add(Words& words, const RequestInForce& request) {
  words.push_back(request.request_id);
  words.push_back(request.cancelled ? 1 : 0);
  Add(words, request.start);
  Add(words, request.goal);
}

void Add(Words& words, const BaselineEvent& baseline) {
  words.push_back(baseline.session);
  words.push_back(baseline.request_id);
  words.push_back(baseline.map_id);
  words.push_back(baseline.baseline_digest);
  words.push_back(DigestOf(baseline.waypoints));
}

void Add(Words& words, const Deployed& deployed) {
  words.push_back(deployed.decision);
  words.push_back(deployed.route_seq);
  words.push_back(deployed.request_id);
  Add(words, deployed.start);
  Add(words, deployed.goal);
  words.push_back(deployed.map_id);
  words.push_back(deployed.baseline_digest);
  words.push_back(static_cast<std::int64_t>(deployed.mode));
  words.push_back(static_cast<std::int64_t>(deployed.cause));
  words.push_back(deployed.source_session);
  words.push_back(deployed.source_attempt);
  words.push_back(deployed.source_candidate);
  words.push_back(DigestOf(deployed.waypoints));
  Add(words, deployed.cost);
  Add(words, deployed.baseline_cost);
}

}  // namespace

std::int64_t CoreDigest(const Gate& gate) {
  Words words;
  words.reserve(64);
  Add(words, gate.request());
  words.push_back(gate.answered_by());
  words.push_back(gate.map_id());
  words.push_back(gate.baseline() != nullptr ? 1 : 0);
  if (gate.baseline() != nullptr) Add(words, *gate.baseline());
  Add(words, gate.deployed());
  words.push_back(gate.driven().place());
  words.push_back(gate.driven().on_route() ? 1 : 0);
  words.push_back(gate.decisions());
  return BytesDigest({reinterpret_cast<const std::uint8_t*>(words.data()),
                      words.size() * sizeof(words[0])});
}

CoreNames NamesOf(const Gate& gate) {
  CoreNames names;
  names.request_id = gate.request().request_id;
  names.request_cancelled = gate.request().cancelled;
  names.answered_by = gate.answered_by();
  names.map_id = gate.map_id();
  if (gate.baseline() != nullptr) {
    names.baseline_digest = gate.baseline()->baseline_digest;
    names.baseline_session = gate.baseline()->session;
  }
  names.route_seq = gate.deployed().route_seq;
  names.place = gate.driven().place();
  if (names.place >= 0) names.place_cell = gate.driven().place_cell();
  names.on_route = gate.driven().on_route();
  names.decisions = gate.decisions();
  names.digest = CoreDigest(gate);
  return names;
}

}  // namespace terra::verifier
