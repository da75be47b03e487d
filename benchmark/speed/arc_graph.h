#pragma once

#include <vector>

namespace terra::benchmark {

/// A map as graph libraries want it: one arc per step, grouped by the cell it
/// leaves (compressed sparse rows), weighted by what the step costs. Plain
/// data, because the libraries are compiled under an older language standard.
struct ArcGraph {
  int width = 0;
  int num_nodes = 0;
  double min_cost = 0;         ///< Of a straight step, for the octile bound.
  std::vector<int> first;      ///< num_nodes + 1 places in `head`.
  std::vector<int> head;       ///< The cell an arc enters, y * width + x.
  std::vector<double> weight;  ///< As long as head.
};

/// Lower bound of the cost between two cells: the octile distance.
double OctileBound(const ArcGraph& graph, int from, int to);

}  // namespace terra::benchmark
