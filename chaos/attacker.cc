#include "chaos/attacker.h"

#include <iterator>
#include <utility>

#include "bus/codec.h"
#include "terrain/native_search.h"
#include "terrain/segment.h"

namespace terra::chaos {
namespace {

using terra_msg::advice_t;
using terra_msg::baseline_t;

constexpr std::size_t kOverheardKept = 16;
constexpr std::size_t kBlockedKept = 4096;

std::vector<Cell> SomeBlockedCells(const TerrainMap& map) {
  std::vector<Cell> cells;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (!map.Passable({x, y})) cells.push_back({x, y});
      if (cells.size() >= kBlockedKept) return cells;
    }
  }
  return cells;
}

}  // namespace

Attacker::Attacker(Identity identity)
    : identity_(std::move(identity)), engine_(identity_.seed) {}

void Attacker::Learn(const baseline_t& baseline, bus::MapPtr map) {
  if (map_ && baseline.baseline_digest != baseline_.baseline_digest) {
    old_baseline_ = std::exchange(baseline_, baseline);
    old_best_ = std::move(best_);
  }
  map_ = std::move(map);
  baseline_ = baseline;
  const SearchResult found =
      NativeSearch(map_->map, {baseline.start_x, baseline.start_y},
                   {baseline.goal_x, baseline.goal_y});
  best_ = found.found() ? CornersOf(found.cells) : bus::WaypointsOf(baseline);
  if (best_.size() > bus::kMaxWaypoints) best_ = bus::WaypointsOf(baseline);
  blocked_ = SomeBlockedCells(map_->map);
}

void Attacker::Overhear(std::span<const std::uint8_t> payload) {
  if (overheard_.size() >= kOverheardKept) overheard_.erase(overheard_.begin());
  overheard_.emplace_back(payload.begin(), payload.end());
}

void Attacker::OverhearDeployed(Message message) {
  if (!identity_.attacks_deployed_bus) return;
  const bus::Channel channel = message.channel;
  overheard_deployed_.insert_or_assign(channel, std::move(message));
}

std::optional<advice_t> Attacker::LastOverheard() const {
  for (auto bytes = overheard_.rbegin(); bytes != overheard_.rend(); ++bytes) {
    const Result<advice_t> advice = bus::Decode<advice_t>(*bytes);
    if (advice) return *advice;
  }
  return std::nullopt;
}

advice_t Attacker::AdviceFor(const baseline_t& baseline, const Route& route) {
  advice_t advice{};
  advice.utime = unix_us_;
  advice.session = identity_.session;
  advice.seq = ++seq_;
  advice.request_id = baseline.request_id;
  advice.map_id = baseline.map_id;
  advice.baseline_digest = baseline.baseline_digest;
  advice.anchor_x = baseline.start_x;
  advice.anchor_y = baseline.start_y;
  advice.advisor = identity_.name;
  advice.method = "chaos";
  advice.backend = "chaos";
  advice.attempt = ++attempt_;
  advice.candidate = 1;
  advice.kind = advice_t::KIND_PROPOSE;
  bus::SetWaypoints(advice, route);
  return advice;
}

advice_t Attacker::Honest() {
  TERRA_REQUIRE(has_baseline());
  return AdviceFor(baseline_, best_);
}

std::optional<advice_t> Attacker::Outdated() {
  if (!old_baseline_) return std::nullopt;
  return AdviceFor(*old_baseline_, old_best_);
}

std::vector<std::uint8_t> Attacker::Bytes(const advice_t& advice) {
  std::vector<std::uint8_t> bytes(
      static_cast<std::size_t>(advice.getEncodedSize()));
  advice.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

Attacker::Message Attacker::Good() {
  if (overheard_deployed_.empty()) {
    return {bus::Channel::kAdvice, Bytes(Honest())};
  }
  const int last = static_cast<int>(overheard_deployed_.size()) - 1;
  return std::next(overheard_deployed_.begin(), Pick(0, last))->second;
}

const std::string& Attacker::AttackedChannel() {
  if (!identity_.attacks_deployed_bus) return channel(bus::Channel::kAdvice);
  return channel(static_cast<bus::Channel>(Pick(0, bus::kNumChannels - 1)));
}

Datagram Attacker::Say(const Message& message) {
  return WholeMessage(NextSequence(), channel(message.channel),
                      message.payload);
}

int Attacker::Pick(int low, int high) {
  const auto span = static_cast<std::uint64_t>(std::int64_t{high} - low) + 1;
  return static_cast<int>(low + static_cast<std::int64_t>(engine_() % span));
}

std::vector<std::uint8_t> Attacker::RandomBytes(int count) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(count));
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(Pick(0, 255));
  }
  return bytes;
}

}  // namespace terra::chaos
