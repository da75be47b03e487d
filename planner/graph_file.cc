#include "planner/graph_file.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "terrain/files/csv.h"

namespace terra::planner {
namespace {

constexpr std::size_t kMaxNameBytes = 31;

using NodeNumbers = std::map<std::string, std::size_t>;

// A table and how to speak of its rows.
struct GraphTable {
  std::string path;
  CsvTable csv;

  const std::string& Field(const CsvRow& row, std::string_view column) const {
    return row.fields[static_cast<std::size_t>(csv.Column(column))];
  }
  Error At(const CsvRow& row, const std::string& what) const {
    return {ErrorCode::kInvalid,
            path + ":" + std::to_string(row.line) + ": " + what};
  }
};

Result<GraphTable> ReadTable(const std::string& path,
                             std::initializer_list<std::string_view> columns,
                             std::size_t max_rows) {
  Result<CsvTable> csv = ReadCsv(path, columns);
  if (!csv.ok()) return csv.error();
  if (csv->rows.size() > max_rows) {
    return Error{ErrorCode::kUnsupported,
                 path + ": more than " + std::to_string(max_rows) + " rows"};
  }
  return GraphTable{path, *std::move(csv)};
}

Result<int> Coordinate(const GraphTable& table, const CsvRow& row,
                       std::string_view column) {
  const Result<int> value = ParseInteger(table.Field(row, column));
  if (!value.ok()) return table.At(row, value.error().message);
  if (*value < 0 || *value >= TerrainMap::kMaxSide) {
    return table.At(row, std::string(column) + " must be 0 to " +
                             std::to_string(TerrainMap::kMaxSide - 1));
  }
  return *value;
}

Status CheckName(const GraphTable& table, const CsvRow& row) {
  const std::string& name = table.Field(row, "name");
  const bool printable = std::all_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
  });
  if (name.empty() || name.size() > kMaxNameBytes || !printable) {
    return table.At(row,
                    "a node's name has 1 to 31 bytes, no control "
                    "characters");
  }
  return Done{};
}

Result<std::vector<WaypointGraph::Node>> ReadNodes(const GraphTable& table) {
  std::vector<WaypointGraph::Node> nodes;
  std::set<std::string> names;
  std::map<Cell, std::string> node_at;
  for (const CsvRow& row : table.csv.rows) {
    const Status name_is_good = CheckName(table, row);
    if (!name_is_good.ok()) return name_is_good.error();
    const std::string& name = table.Field(row, "name");
    const Result<int> x = Coordinate(table, row, "x");
    if (!x.ok()) return x.error();
    const Result<int> y = Coordinate(table, row, "y");
    if (!y.ok()) return y.error();
    if (!names.insert(name).second) {
      return table.At(row, "the node '" + name + "' comes twice");
    }
    const auto [other, is_new] = node_at.try_emplace(Cell{*x, *y}, name);
    if (!is_new) {
      return table.At(row, "the node '" + other->second + "' is at " +
                               ToString(other->first) + " too");
    }
    nodes.push_back({name, {*x, *y}});
  }
  return nodes;
}

Result<std::size_t> FindNode(const GraphTable& table, const CsvRow& row,
                             std::string_view column,
                             const NodeNumbers& numbers) {
  const std::string& name = table.Field(row, column);
  const auto found = numbers.find(name);
  if (found == numbers.end()) {
    return table.At(row, "there is no node '" + name + "' in nodes.csv");
  }
  return found->second;
}

Result<std::vector<WaypointGraph::Edge>> ReadEdges(
    const GraphTable& table, const std::vector<WaypointGraph::Node>& nodes) {
  NodeNumbers numbers;
  for (const WaypointGraph::Node& node : nodes) {
    numbers.emplace(node.name, numbers.size());
  }
  std::vector<WaypointGraph::Edge> edges;
  std::set<WaypointGraph::Edge> known;
  std::int64_t steps = 0;
  for (const CsvRow& row : table.csv.rows) {
    const Result<std::size_t> from = FindNode(table, row, "from", numbers);
    if (!from.ok()) return from.error();
    const Result<std::size_t> to = FindNode(table, row, "to", numbers);
    if (!to.ok()) return to.error();
    if (*from == *to) {
      return table.At(row, "an edge from a node to itself");
    }
    if (!known.insert(std::minmax(*from, *to)).second) {
      return table.At(row,
                      "this edge is there already (one row is for both "
                      "directions)");
    }
    steps += ChebyshevDistance(nodes[*from].cell, nodes[*to].cell);
    if (steps > WaypointGraph::kMaxTotalSteps) {
      return table.At(row, "the edges up to here have more than " +
                               std::to_string(WaypointGraph::kMaxTotalSteps) +
                               " cells together");
    }
    edges.emplace_back(*from, *to);
  }
  return edges;
}

}  // namespace

Result<WaypointGraph> ReadWaypointGraph(const std::string& folder) {
  const Result<GraphTable> node_table = ReadTable(
      folder + "/nodes.csv", {"name", "x", "y"}, WaypointGraph::kMaxNodes);
  if (!node_table.ok()) return node_table.error();
  const Result<GraphTable> edge_table = ReadTable(
      folder + "/edges.csv", {"from", "to"}, WaypointGraph::kMaxEdges);
  if (!edge_table.ok()) return edge_table.error();
  Result<std::vector<WaypointGraph::Node>> nodes = ReadNodes(*node_table);
  if (!nodes.ok()) return nodes.error();
  const Result<std::vector<WaypointGraph::Edge>> edges =
      ReadEdges(*edge_table, *nodes);
  if (!edges.ok()) return edges.error();
  return WaypointGraph(*std::move(nodes), *edges);
}

}  // namespace terra::planner
