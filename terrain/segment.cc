#include "terrain/segment.h"

#include "terrain/require.h"

namespace terra {

CellPath RasterizeSegment(Cell from, Cell to) {
  CellPath cells;
  cells.reserve(static_cast<std::size_t>(ChebyshevDistance(from, to)) + 1);
  SegmentCells walk(from, to);
  cells.push_back(walk.cell());
  while (!walk.done()) {
    walk.Next();
    cells.push_back(walk.cell());
  }
  return cells;
}

CellPath RasterizeRoute(const Route& route) {
  CellPath cells;
  if (route.empty()) {
    return cells;
  }
  cells.push_back(route.front());
  for (std::size_t i = 1; i < route.size(); ++i) {
    SegmentCells walk(route[i - 1], route[i]);
    while (!walk.done()) {
      walk.Next();
      cells.push_back(walk.cell());
    }
  }
  return cells;
}

Route CornersOf(const CellPath& path) {
  TERRA_REQUIRE(!path.empty());
  Route corners = {path.front()};
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const Cell before{path[i].x - path[i - 1].x, path[i].y - path[i - 1].y};
    const Cell after{path[i + 1].x - path[i].x, path[i + 1].y - path[i].y};
    if (before != after) {
      corners.push_back(path[i]);
    }
  }
  corners.push_back(path.back());
  return corners;
}

}  // namespace terra
