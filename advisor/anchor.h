#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "terrain/anchor.h"
#include "terrain/cell.h"
#include "terrain/driven_route.h"

namespace terra::advisor {

/// The route to drive, as DEPLOYED says.
struct DeployedRoute {
  std::int64_t session = 0;
  std::int64_t route_seq = 0;
  std::int64_t request_id = 0;
  std::int64_t map_id = 0;
  Route waypoints;  ///< Empty in the modes without a route.
};

/// What an advisor asks about.
struct AnchorQuestion {
  std::int64_t request_id = 0;
  std::int64_t map_id = 0;
  Cell start;            ///< The request's.
  double latency_s = 0;  ///< How long an answer may take.
  double now_s = 0;      ///< Of any steady clock.
};

/// Knows where the robot is on the deployed route, as the gate knows it, and
/// chooses where a proposal has to start so that it does not come too late.
///
/// A robot that stands at the start, or of which nothing is heard, gets a
/// proposal from the start: the paper's case. One that drives gets it from as
/// far ahead as it comes while the answer is found, and some cells more.
/// Source: Apollo plans from where the robot will be, too.
/// Pure: time is an argument. Threads: one.
class AnchorChooser {
 public:
  /// Cells beyond the distance driven in the meantime.
  static constexpr int kMarginCells = 10;
  /// After so long without a pose nothing is known of the robot's speed.
  static constexpr double kPoseSeconds = 2;

  void OnDeployed(DeployedRoute route);
  /// A pose and the route it follows; any values may come.
  void OnPose(std::int64_t session, std::int64_t route_seq, Cell cell,
              double cells_per_s, double now_s);

  /// None: wait for the next DEPLOYED or POSE. The route of a robot that drives
  /// is not known yet, it is off its route, or too close to the goal.
  std::optional<Anchor> Choose(const AnchorQuestion& question) const;

  /// Could the gate still take a proposal from there, for this request?
  bool InForce(const Anchor& anchor, std::int64_t request_id) const;

  /// Waypoints that visit exactly the deployed route's cells from an anchor on.
  /// Pre: InForce for the request of DEPLOYED, index above 0.
  Route RouteFrom(const Anchor& anchor) const;

 private:
  bool Drives(double now_s) const;

  DeployedRoute deployed_;
  DrivenRoute driven_;
  double cells_per_s_ = 0;
  std::optional<double> pose_at_s_;
};

/// How long answers take, from those that came: a little more than the longest
/// of the last few.
class AnswerTime {
 public:
  explicit AnswerTime(double first_guess_s) : guess_s_(first_guess_s) {}

  void Add(double seconds);
  /// A task was still not done after so long: the next ones get twice that.
  void AtLeast(double seconds);
  double seconds() const { return guess_s_; }

 private:
  static constexpr std::size_t kKept = 8;
  static constexpr double kReserve = 1.2;

  double guess_s_;
  std::array<double, kKept> last_{};
  std::size_t count_ = 0;
};

}  // namespace terra::advisor
