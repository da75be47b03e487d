#pragma once

#include <cstdint>
#include <vector>

#include "terrain/map.h"
#include "verifier/verify.h"

namespace terra::verifier {

/// A cost of (straight + diagonal sqrt 2) / 1e8, exactly.
struct ExactCost {
  std::int64_t straight = 0;
  std::int64_t diagonal = 0;

  double value() const;
  friend ExactCost operator+(const ExactCost& a, const ExactCost& b) {
    return {a.straight + b.straight, a.diagonal + b.diagonal};
  }
};

/// Returns whether a < b - 1e-6, decided in integers.
bool ExactlyCheaper(const ExactCost& a, const ExactCost& b);

struct OracleCheck {
  Code code = Code::kNotChecked;
  ExactCost cost;  ///< Only when kFeasible.
  bool feasible() const { return code == Code::kFeasible; }
};

/// A second reading of the rules, slow and without any of the project's own
/// code for segments, costs or checks. Costs must be multiples of 1e-8.
OracleCheck OracleCheckRoute(const TerrainMap& map, const Route& route,
                             Cell start, Cell goal);

/// The cells of a feasible route, one after the other.
std::vector<Cell> OracleCells(const TerrainMap& map, const Route& route);

}  // namespace terra::verifier
