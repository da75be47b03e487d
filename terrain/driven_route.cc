#include "terrain/driven_route.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "terrain/require.h"
#include "terrain/route_cost.h"
#include "terrain/segment.h"

namespace terra {
namespace {

// Squared distance; nothing where it is beyond the tolerance. The first test
// keeps the squares of hostile coordinates from overflowing.
std::optional<std::int64_t> Distance(Cell a, Cell b) {
  if (ChebyshevDistance(a, b) > DrivenRoute::kToleranceCells) {
    return std::nullopt;
  }
  const std::int64_t dx = a.x - b.x;
  const std::int64_t dy = a.y - b.y;
  return dx * dx + dy * dy;
}

}  // namespace

void DrivenRoute::Follow(const Route& waypoints) {
  CellPath cells = RasterizeRoute(waypoints);
  const auto parting =
      std::mismatch(cells.begin(), cells.end(), cells_.begin(), cells_.end());
  const auto shared = static_cast<std::size_t>(parting.first - cells.begin());
  if (shared <= place_) {
    place_ = 0;
    on_route_ = true;
  }
  waypoints_ = waypoints;
  cells_ = std::move(cells);
}

bool DrivenRoute::FollowFrom(const Route& waypoints, int place, bool on_route) {
  CellPath cells = RasterizeRoute(waypoints);
  const bool fits =
      cells.empty() ? place == -1 : place >= 0 && place < std::ssize(cells);
  if (!fits) return false;
  waypoints_ = waypoints;
  cells_ = std::move(cells);
  place_ = cells_.empty() ? 0 : static_cast<std::size_t>(place);
  on_route_ = on_route;
  return true;
}

// Of equally near cells the last one counts: advice is rather late than
// deployed behind the robot.
void DrivenRoute::OnPose(Cell pose) {
  const std::size_t window_end =
      std::min(cells_.size(), place_ + kWindowCells + 1);
  std::optional<std::int64_t> nearest;
  std::size_t found = place_;
  for (std::size_t i = place_; i < window_end; ++i) {
    const std::optional<std::int64_t> distance = Distance(pose, cells_[i]);
    if (distance && (!nearest || *distance <= *nearest)) {
      nearest = distance;
      found = i;
    }
  }
  for (std::size_t i = window_end; !nearest && i < cells_.size(); ++i) {
    nearest = Distance(pose, cells_[i]);
    if (nearest) found = i;
  }
  on_route_ = nearest.has_value();
  place_ = found;
}

bool DrivenRoute::Passed(int index) const {
  // Below 0 it becomes larger than any size.
  const auto at = static_cast<std::size_t>(index);
  return !on_route_ || at < place_ || at >= cells_.size();
}

Cell DrivenRoute::cell(int index) const {
  TERRA_REQUIRE(!Passed(index));
  return cells_[static_cast<std::size_t>(index)];
}

double DrivenRoute::CostFrom(const TerrainMap& map, int index) const {
  TERRA_REQUIRE(!Passed(index));
  const std::span<const Cell> cells = cells_;
  return WalkRoute(map, cells.subspan(static_cast<std::size_t>(index))).cost;
}

Route DrivenRoute::RouteFrom(int index) const {
  TERRA_REQUIRE(!Passed(index));
  return CornersOf(CellPath(cells_.begin() + index, cells_.end()));
}

Route DrivenRoute::JoinAt(int index, const Route& tail) const {
  TERRA_REQUIRE(!tail.empty() && cell(index) == tail.front());
  // The waypoints up to the anchor, without repeated ones, so that padding does
  // not use up the limit; then the corners from the last of them on.
  Route joined = {waypoints_.front()};
  std::int64_t at = 0;
  for (std::size_t i = 1; at < index; ++i) {
    const std::int64_t next =
        at + ChebyshevDistance(waypoints_[i - 1], waypoints_[i]);
    if (next > index) break;
    if (next > at) joined.push_back(waypoints_[i]);
    at = next;
  }
  if (at < index) {
    const Route corners =
        CornersOf(CellPath(cells_.begin() + at, cells_.begin() + index + 1));
    joined.insert(joined.end(), corners.begin() + 1, corners.end());
  }
  joined.insert(joined.end(), tail.begin() + 1, tail.end());
  return joined;
}

}  // namespace terra
