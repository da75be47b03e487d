#include "benchmark/speed/textbook_peer.h"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <queue>
#include <utility>
#include <vector>

#include "terrain/search_steps.h"

namespace terra::benchmark {
namespace {

class TextbookPeer : public Peer {
 public:
  explicit TextbookPeer(const TerrainMap& map) : map_(map) {}

  double Search(int start, int goal) override {
    const auto size = static_cast<std::size_t>(map_.width() * map_.height());
    std::vector<double> distance(size, kImpassable);
    std::vector<int> predecessor(size, -1);
    std::vector<bool> closed(size, false);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    distance[static_cast<std::size_t>(start)] = 0;
    open.emplace(Octile(CellOf(start), CellOf(goal)), start);
    while (!open.empty()) {
      const int node = open.top().second;
      open.pop();
      const auto n = static_cast<std::size_t>(node);
      if (node == goal) {
        path_.clear();
        for (int at = goal; at != -1;) {
          path_.push_back(CellOf(at));
          at = predecessor[static_cast<std::size_t>(at)];
        }
        std::reverse(path_.begin(), path_.end());
        return distance[n];
      }
      if (closed[n]) continue;
      closed[n] = true;
      const Cell cell = CellOf(node);
      for (const Cell step : kSteps) {
        const Cell to{cell.x + step.x, cell.y + step.y};
        if (!map_.Contains(to) || !map_.Passable(to)) continue;
        const bool diagonal = step.x != 0 && step.y != 0;
        const double through =
            distance[n] +
            map_.Cost(to) * (diagonal ? std::numbers::sqrt2 : 1.0);
        const int next = to.y * map_.width() + to.x;
        if (through < distance[static_cast<std::size_t>(next)]) {
          distance[static_cast<std::size_t>(next)] = through;
          predecessor[static_cast<std::size_t>(next)] = node;
          open.emplace(through + Octile(to, CellOf(goal)), next);
        }
      }
    }
    return kImpassable;
  }

 private:
  Cell CellOf(int node) const {
    return {node % map_.width(), node / map_.width()};
  }

  double Octile(Cell from, Cell to) const {
    const int dx = std::abs(from.x - to.x);
    const int dy = std::abs(from.y - to.y);
    constexpr double kTurn = 0.41421356237309503;  // Below sqrt 2 - 1.
    return map_.costs().min_cost() *
           (std::max(dx, dy) + kTurn * std::min(dx, dy));
  }

  const TerrainMap& map_;
  CellPath path_;  // What the caller would drive.
};

}  // namespace

std::unique_ptr<Peer> MakeTextbookPeer(const TerrainMap& map) {
  return std::make_unique<TextbookPeer>(map);
}

}  // namespace terra::benchmark
