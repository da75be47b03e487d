// Advice with a good route that lies about everything else, and messages that
// are none of an advisor's business.
#include <limits>

#include "bus/codec.h"
#include "chaos/faults.h"
#include "terrain/digest.h"

namespace terra::chaos {
namespace {

using terra_msg::advice_t;
using terra_msg::baseline_t;
using terra_msg::deployed_t;

constexpr std::int64_t kInt64Max = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kInt64Min = std::numeric_limits<std::int64_t>::min();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

template <typename T, std::size_t n>
T OneOf(Attacker& attacker, const T (&values)[n]) {
  return values[attacker.Pick(0, static_cast<int>(n) - 1)];
}

template <typename Message>
Datagram OnChannel(Attacker& attacker, const Message& message) {
  return WholeMessage(attacker.NextSequence(),
                      attacker.channel(bus::MessageTraits<Message>::kChannel),
                      bus::Encode(message));
}

}  // namespace

std::vector<Datagram> Honest(Attacker& attacker) {
  return {attacker.Say(attacker.Honest())};
}

std::vector<Datagram> WrongRequest(Attacker& attacker) {
  advice_t advice = attacker.Honest();
  advice.request_id = OneOf<std::int64_t>(
      attacker, {0, advice.request_id + 1, -advice.request_id, kInt64Max});
  return {attacker.Say(advice)};
}

std::vector<Datagram> WrongMap(Attacker& attacker) {
  advice_t advice = attacker.Honest();
  advice.map_id =
      OneOf<std::int64_t>(attacker, {0, advice.map_id ^ 1, ~advice.map_id});
  return {attacker.Say(advice)};
}

std::vector<Datagram> WrongBaseline(Attacker& attacker) {
  advice_t advice = attacker.Honest();
  advice.baseline_digest = OneOf<std::int64_t>(
      attacker, {0, advice.baseline_digest ^ 1, ~advice.baseline_digest});
  return {attacker.Say(advice)};
}

std::vector<Datagram> WrongAnchor(Attacker& attacker) {
  advice_t advice = attacker.Honest();
  if (attacker.OneIn(2)) {
    // An index needs the session and number of the route it counts on.
    advice.anchor_index = OneOf<std::int32_t>(
        attacker, {1, 7, -1, std::numeric_limits<std::int32_t>::max(),
                   std::numeric_limits<std::int32_t>::min()});
  } else {
    advice.anchor_x += OneOf<std::int32_t>(attacker, {1, -1, 1000});
  }
  return {attacker.Say(advice)};
}

std::vector<Datagram> LateAdvice(Attacker& attacker) {
  const std::optional<advice_t> outdated = attacker.Outdated();
  if (!outdated) return {};
  return {attacker.Say(*outdated)};
}

std::vector<Datagram> StaleSeq(Attacker& attacker) {
  advice_t advice = attacker.Honest();
  advice.seq = OneOf<std::int64_t>(
      attacker, {0, 1, -1, advice.seq - 1, kInt64Max, kInt64Min});
  return {attacker.Say(advice)};
}

std::vector<Datagram> SameAttempt(Attacker& attacker) {
  const advice_t second = attacker.Honest();
  advice_t first = second;
  first.kind = advice_t::KIND_RETAIN;
  bus::SetWaypoints(first, {});
  return {attacker.Say(first), attacker.Say(second)};
}

std::vector<Datagram> Replay(Attacker& attacker) {
  const auto& overheard = attacker.overheard();
  if (overheard.empty()) return {};
  const int last = static_cast<int>(overheard.size()) - 1;
  return {attacker.Say(
      overheard[static_cast<std::size_t>(attacker.Pick(0, last))])};
}

std::vector<Datagram> Impersonate(Attacker& attacker) {
  const std::optional<advice_t> other = attacker.LastOverheard();
  if (!other || attacker.blocked().empty()) return {};
  advice_t advice = attacker.Honest();
  advice.advisor = other->advisor;
  advice.session = other->session;
  advice.seq = other->seq + 1;
  advice.attempt = other->attempt + 1;
  const Route& best = attacker.best();
  bus::SetWaypoints(advice,
                    {best.front(), attacker.blocked().front(), best.back()});
  return {attacker.Say(advice)};
}

std::vector<Datagram> ClockLies(Attacker& attacker) {
  constexpr std::int64_t kHourUs = 3'600'000'000;
  advice_t advice = attacker.Honest();
  advice.utime = OneOf<std::int64_t>(
      attacker, {0, -1, advice.utime - kHourUs, advice.utime + kHourUs,
                 kInt64Max, kInt64Min});
  return {attacker.Say(advice)};
}

std::vector<Datagram> CostLies(Attacker& attacker) {
  advice_t advice = attacker.Honest();
  advice.spend_usd = OneOf<double>(
      attacker, {kNotANumber, kInfinity, -kInfinity, 1e308, -1.0});
  advice.tokens_in = OneOf<std::int64_t>(attacker, {-1, kInt64Max, kInt64Min});
  advice.t_llm_us = OneOf<std::int64_t>(attacker, {-1, kInt64Max, kInt64Min});
  advice.answer_text = "No. The cost of this route is 0.";
  return {attacker.Say(advice)};
}

std::vector<Datagram> UnknownKind(Attacker& attacker) {
  advice_t advice = attacker.Honest();
  advice.kind = OneOf<std::int8_t>(attacker, {0, 5, -1, 127, -128});
  return {attacker.Say(advice)};
}

std::vector<Datagram> ForgedDeployed(Attacker& attacker) {
  if (attacker.blocked().empty()) return {};
  const advice_t honest = attacker.Honest();
  const Route route = {attacker.best().front(), attacker.blocked().front(),
                       attacker.best().back()};
  baseline_t baseline = attacker.baseline();
  baseline.session = honest.session;
  baseline.seq = honest.seq;
  bus::SetWaypoints(baseline, route);
  baseline.baseline_digest =
      BaselineDigest(baseline.request_id, baseline.map_id, route);
  deployed_t deployed{};
  deployed.session = honest.session;
  deployed.seq = honest.seq;
  deployed.request_id = honest.request_id;
  deployed.map_id = honest.map_id;
  deployed.baseline_digest = baseline.baseline_digest;
  deployed.mode = deployed_t::MODE_CANDIDATE;
  deployed.source = attacker.name();
  bus::SetWaypoints(deployed, route);
  return {OnChannel(attacker, baseline), OnChannel(attacker, deployed)};
}

}  // namespace terra::chaos
