// Gradient-based shortening (Campana, Lamiraux, Laumond 2016) for a point in
// the plane.
//
// The unknowns are the inner waypoints q_1..q_n, real numbers. The objective is
//   f(q) = 1/2 sum_i w_i |q_i - q_(i-1)|^2,
// a quadratic form with a constant tridiagonal Hessian, the same for x and y.
// The weights are frozen on the baseline: 1 / length keeps the ratio of segment
// lengths; cost / length^2 pulls harder where the terrain is dear.
//
// Each iteration goes a part alpha of the way to the minimum under the linear
// constraints found so far. Where a segment then hits an obstacle (or the map's
// edge), the point of it that hit may from now on only move along the line
// across the direction in which it came, and the next step goes all the way
// (alpha = 1); if that hits too, steps are short again. It ends at a free
// minimum, when constraints contradict each other, or when they are too many.
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include "benchmark/methods/comparison_refiners.h"
#include "terrain/require.h"
#include "terrain/route_cost.h"

namespace terra::benchmark {
namespace {

using Eigen::MatrixX2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double kShortSteps = 0.25;
constexpr double kEpsilon = 1e-5;  // Cells; a shorter step is none.
// The published method sets no limit; without obstacles it needs about 50.
constexpr int kMaxIterations = 300;
// Nor this one; each step solves for all constraints at once.
constexpr std::size_t kMaxConstraints = 256;

// All waypoints, one a row, ends included.
using Points = MatrixX2d;

Points ToPoints(const Route& route) {
  Points points(static_cast<Eigen::Index>(route.size()), 2);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Cell c = route[static_cast<std::size_t>(i)];
    points.row(i) << c.x, c.y;
  }
  return points;
}

Route ToRoute(const Points& points) {
  Route route;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    route.push_back({static_cast<int>(std::lround(points(i, 0))),
                     static_cast<int>(std::lround(points(i, 1)))});
  }
  return route;
}

Route WithoutRepeats(const Route& route) {
  Route kept;
  for (const Cell c : route) {
    if (kept.empty() || kept.back() != c) kept.push_back(c);
  }
  return kept;
}

// Where a segment first hits: its number and how far along it.
struct Hit {
  Eigen::Index segment = 0;
  double fraction = 0;
};

// The first hit of each segment. One that begins blocked is left out: the
// segment before it ends there and says so.
std::vector<Hit> FindHits(const TerrainMap& map, const Route& route) {
  std::vector<Hit> hits;
  for (std::size_t i = 1; i < route.size(); ++i) {
    const Cell from = route[i - 1];
    const Cell to = route[i];
    const RouteWalk walk = WalkRoute(map, std::vector<Cell>{from, to});
    if (walk.feasible() || walk.cell == from) continue;
    hits.push_back({static_cast<Eigen::Index>(i - 1),
                    static_cast<double>(ChebyshevDistance(from, walk.cell)) /
                        static_cast<double>(ChebyshevDistance(from, to))});
  }
  return hits;
}

Vector2d PointAt(const Points& points, const Hit& hit) {
  return (1 - hit.fraction) * points.row(hit.segment).transpose() +
         hit.fraction * points.row(hit.segment + 1).transpose();
}

// The minimum of the objective under the constraints.
class Objective {
 public:
  // One weight for each segment.
  explicit Objective(const VectorXd& weights) : weights_(weights) {
    const Eigen::Index n = weights.size() - 1;
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index i = 0; i < n; ++i) {
      entries.emplace_back(i, i, weights(i) + weights(i + 1));
      if (i + 1 < n) {
        entries.emplace_back(i, i + 1, -weights(i + 1));
        entries.emplace_back(i + 1, i, -weights(i + 1));
      }
    }
    Eigen::SparseMatrix<double> hessian(n, n);
    hessian.setFromTriplets(entries.begin(), entries.end());
    solver_.compute(hessian);
    TERRA_REQUIRE(solver_.info() == Eigen::Success);
  }

  // From now on the point at `hit` keeps its distance across `normal`.
  // Rows of J: the point's share of the two waypoints, those that are free.
  void Constrain(const Hit& hit, const Vector2d& normal, double offset) {
    MatrixX2d row = MatrixX2d::Zero(unknowns(), 2);
    if (hit.segment > 0) {
      row.row(hit.segment - 1) = (1 - hit.fraction) * normal.transpose();
    }
    if (hit.segment < unknowns()) {
      row.row(hit.segment) = hit.fraction * normal.transpose();
    }
    constraints_.push_back({row, hit, normal, offset});
    solved_.push_back(solver_.solve(row));
  }

  std::size_t num_constraints() const { return constraints_.size(); }

  // The step from these points to the minimum; none when the constraints are
  // not independent.
  std::optional<Points> StepFrom(const Points& points) const {
    MatrixX2d gradient(unknowns(), 2);
    for (Eigen::Index i = 0; i < unknowns(); ++i) {
      gradient.row(i) =
          weights_(i) * (points.row(i + 1) - points.row(i)) -
          weights_(i + 1) * (points.row(i + 2) - points.row(i + 1));
    }
    MatrixX2d step = -solver_.solve(gradient);
    const auto m = static_cast<Eigen::Index>(constraints_.size());
    if (m > 0) {
      // H p + J^T v = -g and J p = r give (J H^-1 J^T) v = -r - J H^-1 g.
      MatrixXd schur(m, m);
      VectorXd excess(m);
      for (Eigen::Index a = 0; a < m; ++a) {
        const Constraint& c = constraints_[static_cast<std::size_t>(a)];
        for (Eigen::Index b = 0; b < m; ++b) {
          schur(a, b) =
              c.row.cwiseProduct(solved_[static_cast<std::size_t>(b)]).sum();
        }
        const double misses = c.normal.dot(PointAt(points, c.at)) - c.offset;
        excess(a) = misses + c.row.cwiseProduct(step).sum();
      }
      const Eigen::FullPivLU<MatrixXd> lu(schur);
      if (!lu.isInvertible()) return std::nullopt;
      const VectorXd multipliers = lu.solve(excess);
      for (Eigen::Index a = 0; a < m; ++a) {
        step -= multipliers(a) * solved_[static_cast<std::size_t>(a)];
      }
    }
    // Nearly dependent constraints throw the points off the map.
    if (!(step.cwiseAbs().maxCoeff() < 4.0 * TerrainMap::kMaxSide)) {
      return std::nullopt;
    }
    Points whole = Points::Zero(points.rows(), 2);
    whole.middleRows(1, unknowns()) = step;
    return whole;
  }

 private:
  // normal . PointAt(q, at) = offset, and its derivative by the unknowns.
  struct Constraint {
    MatrixX2d row;
    Hit at;
    Vector2d normal;
    double offset;
  };

  Eigen::Index unknowns() const { return weights_.size() - 1; }

  VectorXd weights_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
  std::vector<Constraint> constraints_;
  std::vector<MatrixX2d> solved_;  // H^-1 J^T, constraint by constraint.
};

VectorXd Weights(const TerrainMap& map, const Route& route, CampanaForm form) {
  VectorXd weights(static_cast<Eigen::Index>(route.size()) - 1);
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    const Cell from = route[static_cast<std::size_t>(i)];
    const Cell to = route[static_cast<std::size_t>(i) + 1];
    // Not std::hypot, whose last bit is the library's business.
    const double dx = to.x - from.x;
    const double dy = to.y - from.y;
    const double length = std::sqrt(dx * dx + dy * dy);
    weights(i) = form == CampanaForm::kTerrainWeighted
                     ? SegmentCost(map, from, to) / (length * length)
                     : 1 / length;
  }
  return weights;
}

// The valid iterates, of which the last and the cheapest are kept.
struct Iterates {
  Points last;
  RefineOutput best;

  void Add(const TerrainMap& map, Points points) {
    last = std::move(points);
    Route route = ToRoute(last);
    const double cost = WalkRoute(map, route).cost;
    if (cost < best.cost) best = {std::move(route), cost};
  }
};

// Adds a constraint for each hit; false where a direction cannot be told or
// there are too many.
bool ConstrainHits(const std::vector<Hit>& hits, const Points& free,
                   const Points& blocked, Objective& objective) {
  for (const Hit& hit : hits) {
    const Vector2d free_point = PointAt(free, hit);
    const Vector2d way = free_point - PointAt(blocked, hit);
    if (way.norm() < kEpsilon) return false;
    const Vector2d normal = way.normalized();
    objective.Constrain(hit, normal, normal.dot(free_point));
  }
  return objective.num_constraints() <= kMaxConstraints;
}

void Shorten(const RefineInput& input, CampanaForm form, Iterates& iterates) {
  Objective objective(Weights(input.map, ToRoute(iterates.last), form));
  double alpha = kShortSteps;
  for (int i = 0; i < kMaxIterations && !input.stop.stop_requested(); ++i) {
    const std::optional<Points> step = objective.StepFrom(iterates.last);
    if (!step) return;
    const Points next = iterates.last + alpha * *step;
    const bool at_minimum = alpha == 1 || alpha * step->norm() < kEpsilon;
    const std::vector<Hit> hits = FindHits(input.map, ToRoute(next));
    if (hits.empty()) {
      iterates.Add(input.map, next);
      if (at_minimum) return;
    } else if (alpha != 1) {
      if (!ConstrainHits(hits, iterates.last, next, objective)) return;
      alpha = 1;
    } else {
      alpha = kShortSteps;
    }
  }
}

}  // namespace

RefineOutput RefineByCampana(const RefineInput& input, CampanaForm form) {
  const Route route = WithoutRepeats(input.baseline);
  Iterates iterates;
  iterates.best = {input.baseline, input.baseline_cost};
  if (route.size() < 3) return iterates.best;  // Nothing can move.
  iterates.last = ToPoints(route);
  Shorten(input, form, iterates);
  if (form != CampanaForm::kLastIterate) return iterates.best;
  Route last = ToRoute(iterates.last);
  const double cost = WalkRoute(input.map, last).cost;
  return {std::move(last), cost};
}

}  // namespace terra::benchmark
