#include "logger/log_contents.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

#include "bus/codec.h"
#include "bus/message_texts.h"
#include "logger/log_channels.h"
#include "terrain/digest.h"
#include "verifier/verify.h"

namespace terra::logger {
namespace {

template <typename T>
std::vector<std::uint8_t> WithoutEnvelope(T message) {
  message.utime = 0;
  message.session = 0;
  message.seq = 0;
  return bus::Encode(message);
}

std::string At(const char* what, std::int64_t index) {
  return std::string(what) + " at event " + std::to_string(index);
}

std::string Differs(const char* what, std::int64_t index, std::int64_t first) {
  return At(what, index) + " differs from event " + std::to_string(first) +
         " of the same name";
}

}  // namespace

// ---- Messages ----

LogContents LogContents::Load(LogReader& reader, SealChecker& seals) {
  LogContents contents;
  while (const auto item = reader.Next()) {
    const std::int64_t time_us = item->event.time_us;
    if (contents.events == 0) contents.first_us = contents.last_us = time_us;
    contents.first_us = std::min(contents.first_us, time_us);
    contents.last_us = std::max(contents.last_us, time_us);
    const auto mark = seals.Take(*item);
    if (!mark) contents.Take(item->event, contents.events);
    // One that was put in later would hide what is before it.
    if (mark && mark->mark_kind == terra_msg::log_mark_t::KIND_SNAPSHOT_END &&
        seals.num_broken() == 0 && seals.good() == 2) {
      contents.state_end = contents.events;
    }
    ++contents.events;
  }
  seals.Finish(reader.size());
  contents.Compare();
  return contents;
}

std::vector<const Logged<LogContents::Decided>*> LogContents::DecisionsInOrder()
    const {
  std::vector<const Logged<Decided>*> all;
  for (const auto& [session, of_session] : decisions) {
    for (const auto& [number, logged] : of_session) all.push_back(&logged);
  }
  std::sort(all.begin(), all.end(), [](const auto* a, const auto* b) {
    return a->index < b->index;
  });
  return all;
}

// Finds what shows only when all is known.
void LogContents::Compare() {
  for (std::string& fault : maps.Faults()) {
    conflicts.push_back({0, std::move(fault)});
  }
  for (const auto& [name, said] : baselines) CompareWithRequest(said);
  for (const auto& said : other_baselines) CompareWithRequest(said);
}

void LogContents::CompareWithRequest(
    const Logged<terra_msg::baseline_t>& said) {
  const auto asked = requests.find(said.message.request_id);
  if (asked == requests.end()) return;
  const terra_msg::plan_request_t& request = asked->second.message;
  const terra_msg::baseline_t& baseline = said.message;
  if (std::tie(request.start_x, request.start_y, request.goal_x,
               request.goal_y) != std::tie(baseline.start_x, baseline.start_y,
                                           baseline.goal_x, baseline.goal_y)) {
    conflicts.push_back({said.index, At("BASELINE", said.index) +
                                         " is not for the request of " +
                                         At("its id", asked->second.index)});
  }
}

void LogContents::Take(const LogEvent& event, std::int64_t index) {
  const auto channel = ChannelOf(event.channel);
  if (!channel) return;
  switch (*channel) {
    case bus::Channel::kMapHeader:
      return TakeAs<terra_msg::map_header_t>(event, index);
    case bus::Channel::kMapTile:
      return TakeAs<terra_msg::map_tile_t>(event, index);
    case bus::Channel::kPlanRequest:
      return TakeAs<terra_msg::plan_request_t>(event, index);
    case bus::Channel::kBaseline:
      return TakeAs<terra_msg::baseline_t>(event, index);
    case bus::Channel::kAdvice:
      return TakeAs<terra_msg::advice_t>(event, index);
    case bus::Channel::kVerdict:
      return TakeAs<terra_msg::verdict_t>(event, index);
    case bus::Channel::kDeployed:
      return TakeAs<terra_msg::deployed_t>(event, index);
    case bus::Channel::kPose:
      return TakeAs<terra_msg::pose_t>(event, index);
    case bus::Channel::kConfig:
      return TakeAs<terra_msg::config_t>(event, index);
    case bus::Channel::kStatus:
      return TakeAs<terra_msg::status_t>(event, index);
    case bus::Channel::kMapRequest:
    case bus::Channel::kLog:
    case bus::Channel::kGateStep:
      return;
  }
}

template <typename T>
void LogContents::TakeAs(const LogEvent& event, std::int64_t index) {
  Result<T> message = bus::Decode<T>(event.data);
  if (message) {
    Place(Logged<T>{index, event.time_us, *std::move(message)});
    return;
  }
  ++malformed;
  const auto channel = bus::MessageTraits<T>::kChannel;
  if (channel == bus::Channel::kVerdict || channel == bus::Channel::kDeployed) {
    conflicts.push_back(
        {index, At(bus::BaseName(channel).data(), index) + " cannot be read",
         true});
  }
}

template <typename Key, typename T, typename Other>
void LogContents::Keep(std::map<Key, Logged<T>>& kept, const Key& key,
                       const Logged<Other>& said, const char* what) {
  const auto [place, is_new] = kept.try_emplace(
      key, Logged<T>{said.index, said.time_us, T{said.message}});
  if (!is_new && Essence(place->second.message) != Essence(said.message)) {
    constexpr bool kOfGate = std::is_same_v<T, Decided>;
    conflicts.push_back(
        {said.index, Differs(what, said.index, place->second.index), kOfGate});
  }
}

void LogContents::Place(const Logged<terra_msg::map_header_t>& said) {
  if (maps.Take(said.message)) return;
  conflicts.push_back(
      {said.index, At("MAP_HEADER", said.index) + " is not what it says"});
}

void LogContents::Place(const Logged<terra_msg::map_tile_t>& said) {
  if (maps.Take(said.message)) return;
  conflicts.push_back(
      {said.index, At("MAP_TILE", said.index) + " has sizes that do not fit"});
}

void LogContents::Place(const Logged<terra_msg::plan_request_t>& said) {
  const bool cancel =
      said.message.action == terra_msg::plan_request_t::ACTION_CANCEL;
  if (!cancel && said.message.action != terra_msg::plan_request_t::ACTION_GO) {
    return;  // No process takes it for anything.
  }
  Keep(cancel ? cancels : requests, said.message.request_id, said,
       "PLAN_REQUEST");
}

void LogContents::Place(const Logged<terra_msg::baseline_t>& said) {
  const terra_msg::baseline_t& message = said.message;
  if (message.status != terra_msg::baseline_t::STATUS_OK) {
    if (other_baselines.empty() ||
        Essence(other_baselines.back().message) != Essence(message)) {
      other_baselines.push_back(said);
    }
    return;
  }
  const BaselineName name = {message.baseline_digest, message.session};
  const bool is_new = !baselines.contains(name);
  Keep(baselines, name, said, "BASELINE");
  if (is_new && BaselineDigest(message.request_id, message.map_id,
                               bus::WaypointsOf(message)) != name.digest) {
    conflicts.push_back(
        {said.index, At("BASELINE", said.index) + " is not what it says"});
  }
}

void LogContents::Place(const Logged<terra_msg::advice_t>& said) {
  const terra_msg::advice_t& message = said.message;
  auto& variants =
      advice[{message.request_id, message.map_id, message.baseline_digest,
              message.session, message.attempt, message.candidate}];
  const auto essence = Essence(message);
  for (const Logged<terra_msg::advice_t>& known : variants) {
    if (Essence(known.message) == essence) return;
  }
  // Anybody may copy a name; the gate judges each content of its own.
  if (variants.size() < kMaxVariants) variants.push_back(said);
}

void LogContents::Place(const Logged<terra_msg::pose_t>& said) {
  poses[said.message.deployed_session].push_back(said);
}

void LogContents::CheckNumber(std::int64_t decision, std::int64_t index) {
  if (decision >= 1) return;
  conflicts.push_back(
      {index, At("a decision", index) + " has no number", true});
}

void LogContents::Place(const Logged<terra_msg::verdict_t>& said) {
  CheckNumber(said.message.decision, said.index);
  Keep(decisions[said.message.session], said.message.decision, said, "VERDICT");
}

void LogContents::Place(const Logged<terra_msg::deployed_t>& said) {
  CheckNumber(said.message.decision, said.index);
  first_deployed = std::min(first_deployed, said.index);
  Keep(decisions[said.message.session], said.message.decision, said,
       "DEPLOYED");
}

void LogContents::Place(const Logged<terra_msg::config_t>& said) {
  Keep(configs, said.message.session, said, "CONFIG");
}

void LogContents::Place(const Logged<terra_msg::status_t>& said) {
  statuses.push_back(said);
}

const Logged<terra_msg::baseline_t>* LogContents::FindBaseline(
    std::int64_t digest, std::int64_t session) const {
  auto found = baselines.find({digest, session});
  if (found == baselines.end()) {
    found = baselines.lower_bound(
        {digest, std::numeric_limits<std::int64_t>::min()});
  }
  return found != baselines.end() && found->first.digest == digest
             ? &found->second
             : nullptr;
}

// ---- What a message says ----

std::vector<std::uint8_t> Essence(terra_msg::baseline_t message) {
  message.nodes_expanded = 0;
  message.edges_costed = 0;
  message.search_us = 0;
  return WithoutEnvelope(std::move(message));
}

std::vector<std::uint8_t> Essence(terra_msg::advice_t message) {
  return WithoutEnvelope(std::move(message));
}

std::vector<std::uint8_t> Essence(terra_msg::plan_request_t message) {
  return WithoutEnvelope(std::move(message));
}

std::vector<std::uint8_t> Essence(terra_msg::config_t message) {
  return WithoutEnvelope(std::move(message));
}

// The gate repeats the names of others, cleaned: so must who derives anew what
// it said.
std::vector<std::uint8_t> Essence(terra_msg::deployed_t message) {
  bus::CleanTexts(message);
  return WithoutEnvelope(std::move(message));
}

std::vector<std::uint8_t> Essence(terra_msg::verdict_t message) {
  message.t_det_us = 0;
  bus::CleanTexts(message);
  return WithoutEnvelope(std::move(message));
}

std::vector<std::uint8_t> Essence(const LogContents::Decided& message) {
  return std::visit(
      [](const auto& one) {
        return Essence(one);
      },
      message);
}

std::string InWords(const LogContents::Decided& decided) {
  if (const auto* verdict = std::get_if<terra_msg::verdict_t>(&decided)) {
    return "VERDICT " +
           std::string(verifier::CodeName(verifier::Code{verdict->code})) +
           ", cost " + std::to_string(verdict->candidate_cost) + " against " +
           std::to_string(verdict->cost_to_beat);
  }
  const auto& deployed = std::get<terra_msg::deployed_t>(decided);
  return "DEPLOYED route " + std::to_string(deployed.route_seq) + " in mode " +
         std::to_string(deployed.mode) + ", cause " +
         std::to_string(deployed.cause) + ", cost " +
         std::to_string(deployed.deployed_cost) + " against " +
         std::to_string(deployed.baseline_cost);
}

}  // namespace terra::logger
