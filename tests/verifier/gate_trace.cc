#include "tests/verifier/gate_trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "terrain/digest.h"
#include "tests/support/random_map.h"

namespace terra::verifier {
namespace {

constexpr int kWidth = 7;
constexpr int kHeight = 6;

// Costs that differ by a little less and a little more than epsilon. Both are
// multiples of 3e-8, so that no sum of them differs by exactly epsilon.
Legend NearLegend() {
  return Legend::Create({{0, "obstacle", kImpassable, {0, 0, 0}},
                         {1, "ground", 1, {1, 0, 0}},
                         {2, "a little more", 1 + 93e-8, {2, 0, 0}},
                         {3, "a bit more", 1 + 114e-8, {3, 0, 0}},
                         {4, "slow", 3, {4, 0, 0}}})
      .value();
}

Legend CoarseLegend() {
  return Legend::Create({{0, "obstacle", kImpassable, {0, 0, 0}},
                         {1, "ground", 1, {1, 0, 0}},
                         {2, "grass", 1.5, {2, 0, 0}},
                         {3, "sand", 4, {3, 0, 0}},
                         {4, "mud", 9, {4, 0, 0}}})
      .value();
}

struct World {
  std::vector<std::shared_ptr<const TerrainMap>> maps;
  std::vector<std::int64_t> ids;
};

// Six maps; the last one is smaller, so that a map update can leave a route
// outside.
const World& TheWorld() {
  static const World world = [] {
    World w;
    testing::Random random(77);
    for (int i = 0; i < 6; ++i) {
      const int width = i == 5 ? kWidth - 2 : kWidth;
      ByteRaster raster(kHeight, width);
      for (Eigen::Index k = 0; k < raster.size(); ++k) {
        raster.data()[k] =
            static_cast<std::uint8_t>(random.OneIn(24) ? 0 : random.Int(1, 4));
      }
      w.maps.push_back(std::make_shared<const TerrainMap>(
          TerrainMap::Create(raster, i % 2 == 0 ? NearLegend() : CoarseLegend())
              .value()));
      w.ids.push_back(MapId(*w.maps.back()));
    }
    return w;
  }();
  return world;
}

class Player {
 public:
  void Play(std::uint32_t bits) {
    bits_ = bits;
    switch (Draw(24)) {
      case 0:
        return Feed(Map());
      case 1:
        return Feed(Request());
      case 2:
      case 3:
      case 4:
      case 5:
        return Feed(Baseline());
      case 6:
      case 7:
        return Repeat();
      case 8:
      case 9:
        return Feed(Pose());
      default:
        return Feed(Advice());
    }
  }
  std::vector<Turn> Take() && { return std::move(turns_); }

 private:
  // A number below n out of the random bits (splitmix64, Steele et al. 2014).
  int Draw(std::uint32_t n) {
    bits_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = bits_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<int>((z ^ (z >> 31)) % n);
  }
  bool OneIn(std::uint32_t n) { return Draw(n) == 0; }

  MapEvent Map() {
    const auto k = static_cast<std::size_t>(Draw(6));
    return MapEvent{TheWorld().maps[k], TheWorld().ids[k]};
  }

  RequestEvent Request() {
    RequestEvent event;
    event.request_id =
        OneIn(3) ? Draw(static_cast<std::uint32_t>(next_id_) + 2) : next_id_++;
    event.cancel = OneIn(12);
    event.start = Ends().first;
    event.goal = Ends().second;
    return event;
  }
  std::pair<Cell, Cell> Ends() {
    constexpr std::array<std::pair<Cell, Cell>, 3> kEnds = {
        {{{0, 0}, {6, 5}}, {{0, 3}, {4, 3}}, {{2, 2}, {2, 2}}}};
    return kEnds[static_cast<std::size_t>(next_id_) % kEnds.size()];
  }

  Cell AnyCell() {
    if (OneIn(32)) return Cell{Draw(40) - 20, 2'147'483'647 - Draw(3)};
    return Cell{Draw(kWidth), Draw(kHeight)};
  }

  // A route from here to the goal in force; now and then a wrong one.
  Route AnyRoute(Cell from, int detours) {
    Route route = {from};
    for (int k = detours; k > 0; --k) route.push_back(AnyCell());
    if (!OneIn(24)) route.push_back(now_.deployed.goal);
    if (OneIn(32)) route.front() = AnyCell();
    if (OneIn(40)) route.insert(route.begin(), 2'046, route.front());
    return route;
  }

  PoseEvent Pose() {
    PoseEvent event;
    event.session = kTraceOptions.session + (OneIn(12) ? 1 : 0);
    event.route_seq = now_.deployed.route_seq - (OneIn(12) ? 1 : 0);
    event.cell = now_.cells.empty() || OneIn(8) ? AnyCell() : NextCell();
    return event;
  }
  // The robot is slow, so that anchors ahead of it are left.
  Cell NextCell() {
    const std::size_t next = now_.place + static_cast<std::size_t>(Draw(3));
    return now_.cells[std::min(next, now_.cells.size() - 1)];
  }

  Anchor AnyAnchor() {
    Anchor anchor;
    anchor.cell = now_.deployed.start;
    if (!now_.cells.empty() && OneIn(2)) {
      const auto count = static_cast<std::uint32_t>(now_.cells.size());
      anchor.index = Draw(count);
      anchor.cell = now_.cells[static_cast<std::size_t>(anchor.index)];
      anchor.session = kTraceOptions.session + (OneIn(24) ? 1 : 0);
      anchor.route_seq = now_.deployed.route_seq - (OneIn(24) ? 1 : 0);
    }
    if (OneIn(32)) anchor.cell = AnyCell();
    if (OneIn(32)) anchor.index = Draw(60) - 20;
    return anchor;
  }

  BaselineEvent Baseline() {
    BaselineEvent event;
    event.session = 500 + (OneIn(10) ? 1 : 0);
    event.planner = "planner";
    event.request_id = OneIn(10)
                           ? Draw(static_cast<std::uint32_t>(next_id_) + 1)
                           : now_.deployed.request_id;
    event.start = now_.deployed.start;
    event.goal = now_.deployed.goal;
    event.map_id = OneIn(12) ? TheWorld().ids[static_cast<std::size_t>(Draw(6))]
                             : now_.map_id;
    event.has_route = !OneIn(10);
    event.cancelled = !event.has_route && OneIn(4);
    if (event.has_route) event.waypoints = AnyRoute(event.start, 1 + Draw(2));
    event.baseline_digest =
        BaselineDigest(event.request_id, event.map_id, event.waypoints);
    if (OneIn(20)) ++event.baseline_digest;
    return event;
  }

  AdviceEvent Advice() {
    AdviceEvent event;
    event.session = 900 + Draw(2);
    event.advisor = event.session == 900 ? "search" : "llm";
    event.attempt = OneIn(6) ? Draw(8) : 100 + next_attempt_++;
    event.candidate = Draw(2);
    event.request_id = OneIn(12)
                           ? Draw(static_cast<std::uint32_t>(next_id_) + 1)
                           : now_.deployed.request_id;
    event.map_id = OneIn(12) ? TheWorld().ids[static_cast<std::size_t>(Draw(6))]
                             : now_.map_id;
    event.baseline_digest = now_.baseline ? now_.baseline->baseline_digest : 0;
    if (OneIn(12) && !digests_.empty()) {
      event.baseline_digest = digests_[static_cast<std::size_t>(
          Draw(static_cast<std::uint32_t>(digests_.size())))];
    }
    event.anchor = AnyAnchor();
    event.kind = static_cast<AdviceKind>(OneIn(6) ? Draw(7) - 1 : 2);
    event.waypoints = AnyRoute(event.anchor.cell, Draw(3));
    return event;
  }

  void Repeat() {
    if (turns_.empty()) return;
    const auto count = static_cast<std::uint32_t>(turns_.size());
    const Event event = turns_[static_cast<std::size_t>(Draw(count))].event;
    Feed(event);
  }

  void Feed(const Event& event) {
    Turn turn;
    turn.event = event;
    turn.before = now_;
    turn.decisions = verifier::Feed(gate_, event);
    turn.repeat = NoteAdvice(turn);
    Observe(turn);
    turn.after = now_;
    turns_.push_back(std::move(turn));
  }

  bool NoteAdvice(const Turn& turn) {
    const auto* advice = std::get_if<AdviceEvent>(&turn.event);
    if (advice == nullptr) return false;
    const bool repeat =
        std::find(judged_.begin(), judged_.end(), *advice) != judged_.end();
    if (!turn.decisions.empty()) judged_.push_back(*advice);
    return repeat;
  }

  void Observe(const Turn& turn) {
    const Event& event = turn.event;
    const Deployed before = std::exchange(now_.deployed, gate_.deployed());
    if (const auto* map = std::get_if<MapEvent>(&event)) {
      now_.map = map->map;
      now_.map_id = map->map_id;
    }
    if (before.request_id != now_.deployed.request_id || now_.cancelled()) {
      now_.baseline.reset();
    }
    const auto* said = std::get_if<BaselineEvent>(&event);
    if (said != nullptr && now_.map != nullptr && !now_.cancelled() &&
        said->request_id != 0 && said->request_id == now_.deployed.request_id &&
        said->map_id == now_.map_id) {
      now_.baseline = said->has_route ? std::optional(*said) : std::nullopt;
      if (said->has_route) digests_.push_back(said->baseline_digest);
    }
    if (now_.baseline) CheckBaseline();
    ObserveRobot(turn);
  }

  // On maps this small the window of DrivenRoute is the whole rest of a route
  // of ordinary length; routes that are longer do not arise.
  void ObserveRobot(const Turn& turn) {
    const auto* pose = std::get_if<PoseEvent>(&turn.event);
    if (pose != nullptr && pose->session == kTraceOptions.session &&
        now_.deployed.has_route() &&
        pose->route_seq == now_.deployed.route_seq) {
      ObservePose(pose->cell);
    }
    // One by one: a route that is withdrawn takes the robot's place with it,
    // also where the next one is there at once.
    for (const Decision& decision : turn.decisions) {
      if (const auto* deployed = std::get_if<Deployed>(&decision)) {
        ObserveRoute(*deployed);
      }
    }
  }

  void ObserveRoute(const Deployed& deployed) {
    std::vector<Cell> cells;
    if (deployed.has_route()) {
      cells = OracleCells(*now_.map, deployed.waypoints);
    }
    bool shared = now_.place < cells.size() && now_.place < now_.cells.size();
    for (std::size_t i = 0; shared && i <= now_.place; ++i) {
      shared = cells[i] == now_.cells[i];
    }
    if (!shared) {
      now_.place = 0;
      now_.on_route = true;
    }
    now_.cells = std::move(cells);
  }

  void ObservePose(Cell pose) {
    double nearest = 1e9;
    std::size_t found = now_.place;
    for (std::size_t i = now_.place; i < now_.cells.size(); ++i) {
      const double dx = double{1} * pose.x - now_.cells[i].x;
      const double dy = double{1} * pose.y - now_.cells[i].y;
      if (std::max(std::abs(dx), std::abs(dy)) <= 5 &&
          std::hypot(dx, dy) <= nearest) {
        nearest = std::hypot(dx, dy);
        found = i;
      }
    }
    now_.on_route = nearest < 1e9;
    now_.place = found;
  }

  void CheckBaseline() {
    const BaselineEvent& said = *now_.baseline;
    const bool honest =
        said.baseline_digest ==
        BaselineDigest(said.request_id, said.map_id, said.waypoints);
    now_.baseline_check =
        honest ? OracleCheckRoute(*now_.map, said.waypoints,
                                  now_.deployed.start, now_.deployed.goal)
               : OracleCheck{Code::kMalformedMessage, {}};
  }

  std::uint64_t bits_ = 0;
  std::int64_t next_id_ = 1;
  std::int64_t next_attempt_ = 0;
  std::vector<std::int64_t> digests_;
  std::vector<AdviceEvent> judged_;
  Gate gate_{kTraceOptions};
  Observed now_;
  std::vector<Turn> turns_;
};

}  // namespace

Decisions Feed(Gate& gate, const Event& event) {
  return std::visit(
      [&gate](const auto& e) {
        return gate.On(e);
      },
      event);
}

std::vector<Turn> PlayTrace(std::span<const std::uint32_t> random) {
  Player player;
  for (const std::uint32_t bits : random) {
    player.Play(bits);
  }
  return std::move(player).Take();
}

}  // namespace terra::verifier
