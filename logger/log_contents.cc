#include "logger/log_contents.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <span>
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

// Of the message itself, without what a sender may have put behind it.
template <typename T>
std::int64_t DigestOf(const T& message, std::span<const std::uint8_t> bytes) {
  return BytesDigest(
      bytes.first(static_cast<std::size_t>(message.getEncodedSize())));
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
  for (const auto& [session, of_session] : steps) {
    for (const auto& [number, said] : of_session) {
      CompareWithJournal(said.message);
      TakeBaselineOf(said);
    }
  }
}

// The gate wrote down what it heard of the deployed bus; the recorder heard it
// too.
void LogContents::CompareWithJournal(const terra_msg::gate_step_t& step) {
  std::optional<bus::Channel> channel;
  if (step.kind == terra_msg::gate_step_t::KIND_REQUEST) {
    channel = bus::Channel::kPlanRequest;
  } else if (step.kind == terra_msg::gate_step_t::KIND_BASELINE) {
    channel = bus::Channel::kBaseline;
  } else if (step.kind == terra_msg::gate_step_t::KIND_POSE) {
    channel = bus::Channel::kPose;
  }
  if (!channel) return;
  const auto heard =
      heard_.find({*channel, step.event_session, step.event_seq});
  // Who does not number his messages has more under one name than are kept.
  if (heard == heard_.end() || heard->second.size() >= kMaxVariants ||
      std::ranges::find(heard->second, step.event_digest) !=
          heard->second.end()) {
    return;
  }
  conflicts.push_back({0, std::string(bus::BaseName(*channel)) + " number " +
                              std::to_string(step.event_seq) +
                              " of its sender differs from what step " +
                              std::to_string(step.step) +
                              " of the journal has"});
}

// A baseline that the recorder did not hear is in the gate's journal.
void LogContents::TakeBaselineOf(const Logged<terra_msg::gate_step_t>& said) {
  if (said.message.kind != terra_msg::gate_step_t::KIND_BASELINE) return;
  const auto baseline =
      bus::Decode<terra_msg::baseline_t>(said.message.event_bytes);
  if (!baseline || baseline->status != terra_msg::baseline_t::STATUS_OK) return;
  baselines.try_emplace(
      {baseline->baseline_digest, baseline->session},
      Logged<terra_msg::baseline_t>{said.index, said.time_us, *baseline});
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
    case bus::Channel::kGateStep:
      return TakeAs<terra_msg::gate_step_t>(event, index);
    case bus::Channel::kMapRequest:
    case bus::Channel::kLog:
      return;
  }
}

template <typename T>
void LogContents::TakeAs(const LogEvent& event, std::int64_t index) {
  Result<T> message = bus::Decode<T>(event.data);
  constexpr bus::Channel channel = bus::MessageTraits<T>::kChannel;
  if (message) {
    const Logged<T> said{index, event.time_us, *std::move(message)};
    if constexpr (channel == bus::Channel::kPlanRequest ||
                  channel == bus::Channel::kBaseline ||
                  channel == bus::Channel::kPose) {
      auto& digests = heard_[{channel, said.message.session, said.message.seq}];
      const std::int64_t digest = DigestOf(said.message, event.data);
      if (digests.size() < kMaxVariants &&
          std::ranges::find(digests, digest) == digests.end()) {
        digests.push_back(digest);
      }
    }
    if constexpr (channel == bus::Channel::kAdvice) {
      Place(said, DigestOf(said.message, event.data));
    } else {
      Place(said);
    }
    return;
  }
  ++malformed;
  if (channel == bus::Channel::kVerdict || channel == bus::Channel::kDeployed ||
      channel == bus::Channel::kGateStep) {
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
    constexpr bool kOfGate =
        std::is_same_v<T, Decided> || std::is_same_v<T, terra_msg::gate_step_t>;
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

void LogContents::Place(const Logged<terra_msg::advice_t>& said,
                        std::int64_t digest) {
  const terra_msg::advice_t& message = said.message;
  const AdviceName name = {message.request_id,      message.map_id,
                           message.baseline_digest, message.session,
                           message.attempt,         message.candidate};
  auto& variants = advice[name];
  const auto essence = Essence(message);
  const auto known = std::ranges::find_if(
      variants, [&essence](const Logged<terra_msg::advice_t>& variant) {
        return Essence(variant.message) == essence;
      });
  const auto place = static_cast<std::size_t>(known - variants.begin());
  if (known == variants.end()) {
    // Anybody may copy a name; the gate judges each content of its own.
    if (variants.size() >= kMaxVariants) return;
    variants.push_back(said);
  }
  advice_by_digest_.try_emplace(digest, AdvicePlace{name, place});
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
  decision_of_route_.try_emplace({said.message.session, said.message.route_seq},
                                 said.message.decision);
  Keep(decisions[said.message.session], said.message.decision, said,
       "DEPLOYED");
}

void LogContents::Place(const Logged<terra_msg::gate_step_t>& said) {
  if (said.message.step < 1) {
    conflicts.push_back(
        {said.index, At("GATE_STEP", said.index) + " has no number", true});
    return;
  }
  Keep(steps[said.message.session], said.message.step, said, "GATE_STEP");
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

const Logged<LogContents::Decided>* LogContents::FindDecision(
    std::int64_t session, std::int64_t number) const {
  const auto of_session = decisions.find(session);
  if (of_session == decisions.end()) return nullptr;
  const auto found = of_session->second.find(number);
  return found != of_session->second.end() ? &found->second : nullptr;
}

const terra_msg::deployed_t* LogContents::FindRoute(
    std::int64_t session, std::int64_t route_seq) const {
  const auto decision = decision_of_route_.find({session, route_seq});
  if (decision == decision_of_route_.end()) return nullptr;
  const Logged<Decided>* found = FindDecision(session, decision->second);
  return found != nullptr ? std::get_if<terra_msg::deployed_t>(&found->message)
                          : nullptr;
}

const terra_msg::advice_t* LogContents::FindAdvice(std::int64_t digest) const {
  const auto found = advice_by_digest_.find(digest);
  if (found == advice_by_digest_.end()) return nullptr;
  return &advice.at(found->second.name)[found->second.variant].message;
}

const LogContents::Steps& LogContents::StepsOf(std::int64_t session) const {
  static const Steps none;
  const auto found = steps.find(session);
  return found != steps.end() ? found->second : none;
}

std::vector<std::int64_t> LogContents::GateSessions() const {
  std::set<std::int64_t> sessions;
  for (const auto& [session, of_session] : decisions) sessions.insert(session);
  for (const auto& [session, of_session] : steps) sessions.insert(session);
  return {sessions.begin(), sessions.end()};
}

std::int64_t LogContents::FirstIndexOf(std::int64_t session) const {
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
  const Steps& of_session = StepsOf(session);
  if (!of_session.empty()) first = of_session.begin()->second.index;
  const auto decided = decisions.find(session);
  if (decided != decisions.end()) {
    first = std::min(first, decided->second.begin()->second.index);
  }
  return first;
}

bool LogContents::HasGateBefore(std::int64_t session) const {
  const std::int64_t first = FirstIndexOf(session);
  return std::ranges::any_of(GateSessions(), [&](std::int64_t other) {
    return FirstIndexOf(other) < first;
  });
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

std::vector<std::uint8_t> Essence(terra_msg::gate_step_t message) {
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
