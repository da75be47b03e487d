// Advice that is good but for its route.
#include <limits>

#include "bus/codec.h"
#include "chaos/faults.h"
#include "terrain/segment.h"

namespace terra::chaos {
namespace {

using terra_msg::advice_t;

constexpr int kIntMax = std::numeric_limits<int>::max();
constexpr int kIntMin = std::numeric_limits<int>::min();

// Sets any number of waypoints (bus::SetWaypoints keeps the limit).
void SetRoute(advice_t& advice, const Route& route) {
  advice.num_waypoints = static_cast<std::int32_t>(route.size());
  advice.waypoint_x.clear();
  advice.waypoint_y.clear();
  for (const Cell& cell : route) {
    advice.waypoint_x.push_back(cell.x);
    advice.waypoint_y.push_back(cell.y);
  }
}

std::vector<Datagram> Propose(Attacker& attacker, const Route& route) {
  advice_t advice = attacker.Honest();
  SetRoute(advice, route);
  return {attacker.Say(advice)};
}

// A route that goes to and fro over its first segment: so many waypoints, or
// one less.
Route ToAndFro(const Route& route, std::size_t waypoints) {
  Route longer;
  while (longer.size() + route.size() + 2 <= waypoints) {
    longer.push_back(route[0]);
    longer.push_back(route[1]);
  }
  longer.insert(longer.end(), route.begin(), route.end());
  return longer;
}

}  // namespace

std::vector<Datagram> ThroughObstacles(Attacker& attacker) {
  const auto& blocked = attacker.blocked();
  if (blocked.empty()) return {};
  const auto at = static_cast<std::size_t>(
      attacker.Pick(0, static_cast<int>(blocked.size()) - 1));
  const Route& best = attacker.best();
  return Propose(attacker, {best.front(), blocked[at], best.back()});
}

std::vector<Datagram> Jumps(Attacker& attacker) {
  const int width = attacker.map().width();
  const int height = attacker.map().height();
  const Cell outside[] = {{-1, 0},
                          {0, -1},
                          {width, height - 1},
                          {width - 1, height},
                          {kIntMax, kIntMax},
                          {kIntMin, kIntMin},
                          {kIntMin, kIntMax},
                          {1'000'000, -1'000'000}};
  const Route& best = attacker.best();
  const Cell jump = outside[attacker.Pick(0, std::size(outside) - 1)];
  return Propose(attacker, {best.front(), jump, best.back()});
}

std::vector<Datagram> DuplicatedPoints(Attacker& attacker) {
  Route route;
  const std::size_t room = bus::kMaxWaypoints / attacker.best().size();
  const int times = attacker.Pick(2, static_cast<int>(std::min<std::size_t>(
                                         50, std::max<std::size_t>(room, 2))));
  for (const Cell& cell : attacker.best()) {
    for (int i = 0; i < times; ++i) route.push_back(cell);
  }
  return Propose(attacker, route);
}

std::vector<Datagram> HugeRoutes(Attacker& attacker) {
  // At the limit of waypoints (and, on maps of some size, over that of steps),
  // one above it, and as many as a datagram holds.
  const std::size_t sizes[] = {bus::kMaxWaypoints, bus::kMaxWaypoints + 2,
                               7'000};
  return Propose(attacker,
                 ToAndFro(attacker.best(), sizes[attacker.Pick(0, 2)]));
}

std::vector<Datagram> TooFewPoints(Attacker& attacker) {
  return Propose(attacker,
                 attacker.OneIn(2) ? Route{} : Route{attacker.best().front()});
}

std::vector<Datagram> WrongStart(Attacker& attacker) {
  const CellPath cells = RasterizeRoute(attacker.best());
  if (cells.size() < 3) return {};
  // Cheaper than the best, as it leaves the first step out.
  return Propose(attacker, CornersOf({cells.begin() + 1, cells.end()}));
}

std::vector<Datagram> WrongGoal(Attacker& attacker) {
  const CellPath cells = RasterizeRoute(attacker.best());
  if (cells.size() < 3) return {};
  return Propose(attacker, CornersOf({cells.begin(), cells.end() - 1}));
}

std::vector<Datagram> DearerRoutes(Attacker& attacker) {
  // The first step of the baseline there and back, so that it is feasible.
  const Route baseline = bus::WaypointsOf(attacker.baseline());
  const CellPath cells = RasterizeRoute(baseline);
  if (cells.size() < 2 || baseline.size() + 2 > bus::kMaxWaypoints) return {};
  Route dearer = {cells[0], cells[1]};
  dearer.insert(dearer.end(), baseline.begin(), baseline.end());
  return Propose(attacker, dearer);
}

std::vector<Datagram> Ties(Attacker& attacker) {
  return Propose(attacker, bus::WaypointsOf(attacker.baseline()));
}

}  // namespace terra::chaos
