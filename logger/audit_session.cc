#include "logger/audit_session.h"

#include <algorithm>
#include <utility>

#include "logger/journal_state.h"
#include "terrain/digest.h"
#include "verifier/gate_codec.h"
#include "verifier/gate_options.h"

namespace terra::logger {
namespace {

using terra_msg::deployed_t;
using terra_msg::gate_step_t;
using terra_msg::verdict_t;
using verifier::GateEvent;
using verifier::Lookup;

// A step comes right after its decisions. What the log has heard of one and not
// yet of the other when it ends is no gap.
constexpr std::int64_t kStepComesAfterUs = 1'000'000;

// No gate counts further; so that no number of a log overflows.
constexpr std::int64_t kMostOfAny = std::int64_t{1} << 62;
// More than one event can lead to.
constexpr std::int32_t kMostDecisions = 16;

bool IsCount(std::int64_t number) {
  return number >= 0 && number < kMostOfAny;
}

std::string StepName(std::int64_t step) {
  return "step " + std::to_string(step);
}

// "step 7", "steps 7 to 9".
std::string StepNames(std::int64_t first, std::int64_t last) {
  return first == last
             ? StepName(first)
             : "steps " + std::to_string(first) + " to " + std::to_string(last);
}

std::string LookupName(Lookup lookup) {
  switch (lookup) {
    case Lookup::kNone:
      return "nothing";
    case Lookup::kNew:
      return "new";
    case Lookup::kRepeat:
      return "repeat";
    case Lookup::kReplaced:
      return "replaced";
    case Lookup::kUnknown:
      return "unknown";
  }
  return "number " + std::to_string(static_cast<int>(lookup));
}

// Says in what a step differs from the same one made again; empty where it does
// not.
std::string Difference(const gate_step_t& step, const gate_step_t& again) {
  if (again.num_decisions != step.num_decisions ||
      again.decisions_digest != step.decisions_digest) {
    return "leads to other decisions";
  }
  if (again.lookup != step.lookup) {
    return "finds its event " + LookupName(Lookup{again.lookup}) +
           " in memory and not " + LookupName(Lookup{step.lookup});
  }
  if (again.core_after != step.core_after) return "leads to another core";
  if (Essence(again) != Essence(step)) {
    return "names another core, place or event than the gate had";
  }
  return {};
}

}  // namespace

SessionAudit::SessionAudit(LogContents& contents, std::int64_t session,
                           Audit& audit)
    : contents_(contents), session_(session), audit_(audit) {}

void SessionAudit::Run() {
  if (!ReadOptions()) return;
  for (const auto& [number, logged] : contents_.StepsOf(session_)) {
    Take(logged);
  }
  if (first_step_ == 0) PriceWhatIsInForce();
  CheckUncovered();
}

bool SessionAudit::ReadOptions() {
  const auto config = contents_.configs.find(session_);
  if (config != contents_.configs.end()) {
    Result<verifier::GateOptions> read =
        verifier::ReadGateOptions(config->second.message.config_text);
    if (!read) {
      Fail(Finding::Kind::kMissingInput, 0,
           "the CONFIG of this gate cannot be read, so its margin is not "
           "known: " +
               read.error().message);
      return false;
    }
    options_ = *read;
  }
  // A gate that replays goes by the session it replays.
  if (options_.session == 0) options_.session = session_;
  return true;
}

void SessionAudit::Take(const Logged<Step>& logged) {
  const Step& step = logged.message;
  if (!IsPossible(step)) return;
  if (last_step_ == 0) {
    NoteBegin(logged);
  } else {
    NoteGap(logged);
  }
  last_step_ = step.step;
  last_seq_ = step.seq;
  last_now_us_ = step.now_us;
  last_core_ = step.core_after;
  covered_ = step.decision + step.num_decisions;
  // Of the snapshot's step only where it ended is of use: it was played in the
  // part before.
  if (logged.index < contents_.state_end) return;
  if (first_step_ == 0) first_step_ = step.step;
  if (!StandBefore(step)) {
    audit_.unchecked += step.num_decisions;
    return;
  }
  const std::optional<GateEvent> event = EventOf(step);
  if (event) {
    Play(logged, *event);
  } else {
    gate_.reset();
  }
}

bool SessionAudit::IsPossible(const Step& step) {
  if (IsCount(step.step) && IsCount(step.seq) && IsCount(step.decision) &&
      IsCount(step.route_seq) && step.num_decisions >= 0 &&
      step.num_decisions <= kMostDecisions) {
    return true;
  }
  Fail(Finding::Kind::kConflict, 0,
       StepName(step.step) + " has numbers that no gate counts to");
  return false;
}

// A gate that came after another one of this log began in this log too, with
// step 1. Of the first one the log may lack the beginning.
void SessionAudit::NoteBegin(const Logged<Step>& logged) {
  const Step& step = logged.message;
  if (logged.index < contents_.state_end) return;
  if (step.step == 1) {
    gate_.emplace(options_);
    complete_ = true;
    if (step.core_before != verifier::CoreDigest(*gate_)) {
      Fail(Finding::Kind::kMismatch, step.decision,
           StepName(1) + " begins from a core that no new gate has");
    }
    return;
  }
  if (contents_.HasGateBefore(session_)) {
    Fail(Finding::Kind::kGap, step.decision,
         StepNames(1, step.step - 1) + " of the journal are not in the log");
    return;
  }
  const auto decisions = contents_.decisions.find(session_);
  if (decisions == contents_.decisions.end()) return;
  for (const auto& [number, decided] : decisions->second) {
    if (number > step.decision) break;
    if (decided.index >= contents_.state_end &&
        std::holds_alternative<verdict_t>(decided.message)) {
      ++audit_.unchecked;
    }
  }
}

// What the gate left out to keep its rate has a number and no seq.
void SessionAudit::NoteGap(const Logged<Step>& logged) {
  const Step& step = logged.message;
  if (step.now_us < last_now_us_) {
    Fail(Finding::Kind::kMismatch, step.decision,
         StepName(step.step) + " has an earlier time than the step before");
  }
  if (step.step == last_step_ + 1) {
    if (step.core_before != last_core_ || step.decision != covered_) {
      Fail(Finding::Kind::kMismatch, step.decision,
           StepName(step.step) +
               " begins from another core than the step before ended with");
    }
    return;
  }
  complete_ = false;
  const std::int64_t hidden =
      std::max<std::int64_t>(0, step.decision - covered_);
  // What left no trace was never there: only advice is left out in numbers, and
  // each that has a step has a verdict.
  const bool left_trace = hidden > 0 || step.core_before != last_core_;
  if (step.seq == last_seq_ + 1 && left_trace) {
    audit_.unrecorded += hidden;
    return;
  }
  audit_.unchecked += hidden;
  audit_.Add({Finding::Kind::kGap, session_, step.decision,
              StepNames(last_step_ + 1, step.step - 1) +
                  " of the journal are not in the log"});
}

// Returns whether the gate stands as it did before the step.
bool SessionAudit::StandBefore(const Step& step) {
  if (gate_ && verifier::CoreDigest(*gate_) == step.core_before) return true;
  complete_ = false;
  gate_.reset();
  Result<verifier::Gate> gate = GateBefore(step, options_, contents_);
  if (!gate) return false;
  gate_.emplace(*std::move(gate));
  ++audit_.anchors;
  if (const auto wrong = WrongPrice(gate_->deployed(), contents_)) {
    Fail(Finding::Kind::kMismatch, gate_->deployed().decision, *wrong);
  }
  return true;
}

// A gate that did nothing new while the log was written: what it had deployed
// before is in the log, and can only be priced.
void SessionAudit::PriceWhatIsInForce() {
  const auto decisions = contents_.decisions.find(session_);
  if (decisions == contents_.decisions.end()) return;
  const auto& all = decisions->second;
  if (covered_ == 0 && !contents_.HasGateBefore(session_)) {
    covered_ = all.begin()->first;
  }
  const auto is_deployed = [this](const auto& decision) {
    return decision.first <= covered_ &&
           std::holds_alternative<deployed_t>(decision.second.message);
  };
  const auto last = std::find_if(all.rbegin(), all.rend(), is_deployed);
  if (last == all.rend()) return;
  ++audit_.anchors;
  const auto& message = std::get<deployed_t>(last->second.message);
  if (const auto wrong = WrongPrice(verifier::ToDeployed(message), contents_)) {
    Fail(Finding::Kind::kMismatch, message.decision, *wrong);
  }
}

// The event of a step, with its map; nothing where it cannot be had.
std::optional<GateEvent> SessionAudit::EventOf(const Step& step) {
  if (BytesDigest(step.event_bytes) != step.bytes_digest) {
    Fail(Finding::Kind::kMismatch, step.decision,
         StepName(step.step) + " holds other bytes than it says");
    return std::nullopt;
  }
  const bool is_map = step.kind == gate_step_t::KIND_MAP;
  if (step.event_bytes.empty() && !is_map) return EventFromLog(step);
  const bool as_heard = step.kind != gate_step_t::KIND_ADVICE && !is_map;
  if (as_heard && step.bytes_digest != step.event_digest) {
    Fail(Finding::Kind::kMismatch, step.decision,
         StepName(step.step) + " holds other bytes than were heard");
    return std::nullopt;
  }
  Result<GateEvent> event = verifier::EventOf(step, step.event_bytes);
  if (!event) {
    Fail(Finding::Kind::kConflict, step.decision,
         StepName(step.step) + ": " + event.error().message);
    return std::nullopt;
  }
  auto* map_event = std::get_if<verifier::MapEvent>(&*event);
  if (map_event != nullptr && !FindMap(step, *map_event)) return std::nullopt;
  return *std::move(event);
}

bool SessionAudit::FindMap(const Step& step, verifier::MapEvent& event) {
  const bus::MapPtr map = contents_.maps.Find(event.map_id);
  if (!map) {
    audit_.unchecked += step.num_decisions;
    Fail(Finding::Kind::kMissingInput, step.decision,
         "the log does not hold map " + std::to_string(event.map_id) + " of " +
             StepName(step.step));
    return false;
  }
  event.map = std::shared_ptr<const TerrainMap>(map, &map->map);
  return true;
}

// The gate left the bytes out to keep its rate; the recorder may have heard the
// advice itself. Of the deployed bus so much changes only where somebody who is
// trusted floods it. Advice that led to nothing has no step.
std::optional<GateEvent> SessionAudit::EventFromLog(const Step& step) {
  if (step.kind != gate_step_t::KIND_ADVICE || step.num_decisions == 0) {
    audit_.unchecked += step.num_decisions;
    Fail(Finding::Kind::kMissingInput, step.decision,
         StepName(step.step) +
             " does not hold its event: more changed on the deployed bus than "
             "a journal takes");
    return std::nullopt;
  }
  const terra_msg::advice_t* advice = contents_.FindAdvice(step.event_digest);
  if (advice != nullptr) return GateEvent(verifier::ToEvent(*advice));
  audit_.unrecorded += step.num_decisions;
  return std::nullopt;
}

void SessionAudit::Play(const Logged<Step>& logged, const GateEvent& event) {
  const Step& step = logged.message;
  const verifier::CoreNames before = verifier::NamesOf(*gate_);
  const verifier::Decisions decisions = Decide(step, event);
  const std::string differs =
      Difference(step, StepAgain(step, before, event, decisions));
  if (!differs.empty()) {
    Fail(Finding::Kind::kMismatch, step.decision + 1,
         StepName(step.step) + ", played again, " + differs);
    gate_.reset();
    return;
  }
  ++audit_.steps;
  for (const verifier::Decision& made : decisions) {
    CompareDecision(made, logged);
  }
}

// The step as the gate here would write it.
SessionAudit::Step SessionAudit::StepAgain(
    const Step& step, const verifier::CoreNames& before, const GateEvent& event,
    const verifier::Decisions& decisions) const {
  verifier::JournalEvent heard;
  heard.kind = step.kind;
  if (const auto* map_event = std::get_if<verifier::MapEvent>(&event)) {
    heard = verifier::InJournal(*map_event);
  } else {
    heard.heard = {step.event_session, step.event_seq, step.event_digest};
  }
  Step again = verifier::ToStep(heard, gate_->lookup(), step.now_us, before,
                                decisions, verifier::CoreDigest(*gate_));
  again.step = step.step;
  again.bytes_digest = step.bytes_digest;
  again.num_bytes = step.num_bytes;
  again.event_bytes = step.event_bytes;
  return again;
}

// Where the log lacks steps it lacks memories too, and what the gate's said is
// taken as given.
verifier::Decisions SessionAudit::Decide(const Step& step,
                                         const GateEvent& event) {
  const auto* advice = std::get_if<verifier::AdviceEvent>(&event);
  const bool remembers = complete_ && gate_->remembers_all_judged();
  if (advice != nullptr && !remembers) {
    ++audit_.lookups_given;
    return gate_->OnGiven(*advice, Lookup{step.lookup});
  }
  return std::visit(
      [this](const auto& one) {
        return gate_->On(one);
      },
      event);
}

void SessionAudit::CompareDecision(const verifier::Decision& made,
                                   const Logged<Step>& logged) {
  const Decided message = std::visit(
      [](const auto& one) -> Decided {
        if constexpr (std::is_same_v<std::decay_t<decltype(one)>,
                                     verifier::Verdict>) {
          return verifier::ToMessage(one, 0);
        } else {
          return verifier::ToMessage(one);
        }
      },
      made);
  const std::int64_t number = std::visit(
      [](const auto& one) {
        return one.decision;
      },
      made);
  const Logged<Decided>* said = contents_.FindDecision(session_, number);
  if (said == nullptr) {
    // Before the first step that the log has, it may lack the decisions too.
    const bool at_begin = !complete_ && logged.message.step == first_step_;
    if (at_begin || IsAtTheEnd(logged.time_us)) {
      ++audit_.unchecked;
    } else {
      Fail(Finding::Kind::kGap, number,
           "this decision of " + StepName(logged.message.step) +
               " is not in the log");
    }
  } else if (Essence(said->message) != Essence(message)) {
    Fail(Finding::Kind::kMismatch, number,
         "the log says " + InWords(said->message) +
             ", but from its inputs follows " + InWords(message));
  } else {
    ++(std::holds_alternative<verdict_t>(message) ? audit_.verdicts
                                                  : audit_.deployed);
  }
}

// Decisions of the gate that no step accounts for.
void SessionAudit::CheckUncovered() {
  const auto decisions = contents_.decisions.find(session_);
  if (decisions == contents_.decisions.end()) return;
  const auto& all = decisions->second;
  // Of a gate that ended before this log only the state is in it.
  const bool ended_before =
      last_step_ == 0 && all.rbegin()->second.index < contents_.state_end;
  if (ended_before) return;
  for (auto at = all.upper_bound(covered_); at != all.end(); ++at) {
    if (IsAtTheEnd(at->second.time_us)) {
      ++audit_.unchecked;
      continue;
    }
    Fail(Finding::Kind::kGap, at->first,
         "decisions " + std::to_string(at->first) + " to " +
             std::to_string(all.rbegin()->first) +
             " have no step in the journal");
    return;
  }
}

bool SessionAudit::IsAtTheEnd(std::int64_t time_us) const {
  std::int64_t before_end = 0;
  return __builtin_sub_overflow(contents_.last_us, time_us, &before_end) ==
             false &&
         before_end <= kStepComesAfterUs;
}

void SessionAudit::Fail(Finding::Kind kind, std::int64_t decision,
                        std::string what) {
  audit_.Add({kind, session_, decision, std::move(what)});
}

}  // namespace terra::logger
