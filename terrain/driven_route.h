#pragma once

#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra {

/// The deployed route as a robot drives it: its dense cells and how far along
/// them the robot has come.
///
/// Frame:   map cells; indices count the dense cells from 0 = the start.
/// Threads: one.
class DrivenRoute {
 public:
  /// A pose further than this from the route is off the route.
  static constexpr int kToleranceCells = 5;
  /// How far ahead a pose is looked for first, so that a route which comes by
  /// the same place twice does not lose its place.
  static constexpr int kWindowCells = 50;

  /// Another route is in force. The place along it is kept where both have the
  /// same cells up to the robot, else it is the start. Empty = no route.
  void Follow(const Route& waypoints);

  /// Follows a route with the robot at a place along it, as if it had come
  /// there. Returns false, and does nothing, where the route has no such place.
  bool FollowFrom(const Route& waypoints, int place, bool on_route);

  /// The robot is at this cell, which may be any. Its place never goes back: it
  /// is the nearest cell within the window ahead, else the first one beyond it
  /// within the tolerance. A robot that is at neither is off the route until a
  /// pose is on it again.
  void OnPose(Cell pose);

  /// Index of the cell that the robot has reached, and of the last cell; -1
  /// without a route.
  int place() const { return cells_.empty() ? -1 : static_cast<int>(place_); }
  /// Its cell. Pre: place() is not -1.
  Cell place_cell() const { return cells_[place_]; }
  int last_index() const { return static_cast<int>(cells_.size()) - 1; }
  bool on_route() const { return on_route_; }

  /// Returns whether a proposal may no longer start at this index: the robot
  /// has passed it or is off the route, or there is no such cell.
  bool Passed(int index) const;

  /// The dense cell at an index. Pre: not Passed(index).
  Cell cell(int index) const;

  /// The cost from an index on to the goal. Pre: not Passed(index); the route
  /// is feasible on the map.
  double CostFrom(const TerrainMap& map, int index) const;

  /// Returns waypoints that visit exactly the dense cells from an index on.
  /// Pre: not Passed(index).
  Route RouteFrom(int index) const;

  /// Returns waypoints that visit exactly the dense cells up to an index, then
  /// those of the tail. A polyline cut inside a segment would visit others, so
  /// the cut segment is given by its corners.
  /// Pre: not Passed(index); the tail starts at cell(index).
  Route JoinAt(int index, const Route& tail) const;

 private:
  Route waypoints_;
  CellPath cells_;
  std::size_t place_ = 0;
  bool on_route_ = true;
};

}  // namespace terra
