#include "advisor/anchor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "terrain/require.h"

namespace terra::advisor {
namespace {

// Faster than any ground robot on any map: a hostile pose overflows nothing.
constexpr double kMaxCellsPerSecond = 10'000;

}  // namespace

void AnchorChooser::OnDeployed(DeployedRoute route) {
  const bool same = route.session == deployed_.session &&
                    route.route_seq == deployed_.route_seq;
  if (same) return;
  driven_.Follow(route.waypoints);
  deployed_ = std::move(route);
}

void AnchorChooser::OnPose(std::int64_t session, std::int64_t route_seq,
                           Cell cell, double cells_per_s, double now_s) {
  const bool sensible = std::isfinite(cells_per_s) && cells_per_s > 0;
  cells_per_s_ = sensible ? std::min(cells_per_s, kMaxCellsPerSecond) : 0;
  pose_at_s_ = now_s;
  const bool on_deployed = session == deployed_.session &&
                           route_seq == deployed_.route_seq &&
                           !deployed_.waypoints.empty();
  if (on_deployed) driven_.OnPose(cell);
}

bool AnchorChooser::Drives(double now_s) const {
  return pose_at_s_ && now_s - *pose_at_s_ <= kPoseSeconds && cells_per_s_ > 0;
}

std::optional<Anchor> AnchorChooser::Choose(
    const AnchorQuestion& question) const {
  const Anchor at_start{0, 0, 0, question.start};
  const bool route_known = deployed_.request_id == question.request_id &&
                           deployed_.map_id == question.map_id &&
                           !deployed_.waypoints.empty();
  const bool drives = Drives(question.now_s);
  if (!route_known) {
    return drives ? std::nullopt : std::optional(at_start);
  }
  if (!driven_.on_route()) return std::nullopt;
  if (driven_.place() == 0 && !drives) return at_start;
  const double ahead = std::ceil(cells_per_s_ * question.latency_s);
  const double index = driven_.place() + ahead + kMarginCells;
  if (index >= driven_.last_index()) return std::nullopt;
  const auto chosen = static_cast<std::int32_t>(index);
  return Anchor{deployed_.session, deployed_.route_seq, chosen,
                driven_.cell(chosen)};
}

// As Gate::AnchorInForce.
bool AnchorChooser::InForce(const Anchor& anchor,
                            std::int64_t request_id) const {
  if (deployed_.request_id != request_id || deployed_.waypoints.empty()) {
    return anchor.index == 0;
  }
  const bool names_route = anchor.session == deployed_.session &&
                           anchor.route_seq == deployed_.route_seq;
  return (anchor.index == 0 || names_route) && !driven_.Passed(anchor.index);
}

Route AnchorChooser::RouteFrom(const Anchor& anchor) const {
  TERRA_REQUIRE(anchor.index > 0 && InForce(anchor, deployed_.request_id));
  return driven_.RouteFrom(anchor.index);
}

void AnswerTime::Add(double seconds) {
  last_[count_ % kKept] = std::max(seconds, 0.0);
  ++count_;
  const auto end =
      last_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kKept));
  guess_s_ = kReserve * *std::max_element(last_.begin(), end);
}

void AnswerTime::AtLeast(double seconds) {
  guess_s_ = std::max(guess_s_, 2 * seconds);
}

}  // namespace terra::advisor
