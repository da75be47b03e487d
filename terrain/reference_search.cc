#include "terrain/reference_search.h"

#include <algorithm>
#include <queue>
#include <utility>
#include <vector>

#include "terrain/route_cost.h"
#include "terrain/search_ends.h"
#include "terrain/steps.h"

namespace terra {
namespace {

bool MayStep(const TerrainMap& map, Cell from, Cell to) {
  if (!map.Contains(to) || !map.Passable(to)) {
    return false;
  }
  if (map.cost_model().corner_cutting || from.x == to.x || from.y == to.y) {
    return true;
  }
  return map.Passable(Cell{to.x, from.y}) && map.Passable(Cell{from.x, to.y});
}

}  // namespace

SearchResult ReferenceSearch(const TerrainMap& map, Cell start, Cell goal) {
  SearchResult result;
  result.status = CheckSearchEnds(map, start, goal);
  if (!result.found()) {
    return result;
  }
  const auto index = [&map](Cell c) {
    return static_cast<std::size_t>(c.y) *
               static_cast<std::size_t>(map.width()) +
           static_cast<std::size_t>(c.x);
  };
  const auto num_cells = static_cast<std::size_t>(map.ids().size());
  std::vector<double> distance(num_cells, kImpassable);
  std::vector<Cell> parent(num_cells, start);
  using Entry = std::pair<double, Cell>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  distance[index(start)] = 0;
  open.emplace(0.0, start);
  while (!open.empty()) {
    const auto [d, cell] = open.top();
    open.pop();
    if (d > distance[index(cell)]) {
      continue;
    }
    ++result.expanded;
    if (cell == goal) {
      break;
    }
    for (const Cell step : kSteps) {
      const Cell next{cell.x + step.x, cell.y + step.y};
      if (!MayStep(map, cell, next)) {
        continue;
      }
      const double candidate = d + StepLength(cell, next) * map.Cost(next);
      if (candidate < distance[index(next)]) {
        distance[index(next)] = candidate;
        parent[index(next)] = cell;
        open.emplace(candidate, next);
      }
    }
  }
  if (distance[index(goal)] == kImpassable) {
    result.status = SearchStatus::kNoRoute;
    return result;
  }
  for (Cell c = goal; c != start; c = parent[index(c)]) {
    result.cells.push_back(c);
  }
  result.cells.push_back(start);
  std::reverse(result.cells.begin(), result.cells.end());
  result.cost = WalkRoute(map, result.cells).cost;
  return result;
}

}  // namespace terra
