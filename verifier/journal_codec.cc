#include "verifier/journal_codec.h"

#include <limits>
#include <utility>

#include "bus/message_texts.h"
#include "terrain/digest.h"
#include "verifier/gate_codec.h"

namespace terra::verifier {
namespace {

using terra_msg::advice_t;
using terra_msg::gate_step_t;

template <typename T>
JournalEvent AsHeard(std::int8_t kind, const T& message) {
  JournalEvent event;
  event.kind = kind;
  event.bytes = bus::Encode(message);
  event.heard = {message.session, message.seq, BytesDigest(event.bytes)};
  return event;
}

advice_t WhatTheGateReads(const AdviceEvent& event) {
  advice_t message{};
  message.session = event.session;
  message.seq = event.heard.seq;
  message.request_id = event.request_id;
  message.map_id = event.map_id;
  message.baseline_digest = event.baseline_digest;
  message.anchor_session = event.anchor.session;
  message.anchor_route_seq = event.anchor.route_seq;
  message.anchor_index = event.anchor.index;
  message.anchor_x = event.anchor.cell.x;
  message.anchor_y = event.anchor.cell.y;
  message.advisor = event.advisor;
  message.attempt = event.attempt;
  message.candidate = event.candidate;
  message.kind = static_cast<std::int8_t>(event.kind);
  message.num_waypoints = static_cast<std::int32_t>(event.waypoints.size());
  for (const Cell cell : event.waypoints) {
    message.waypoint_x.push_back(cell.x);
    message.waypoint_y.push_back(cell.y);
  }
  return message;
}

template <typename T>
void Append(T message, Bytes& bytes) {
  message.utime = 0;
  message.session = 0;
  message.seq = 0;
  bus::CleanTexts(message);
  const Bytes encoded = bus::Encode(message);
  bytes.insert(bytes.end(), encoded.begin(), encoded.end());
}

template <typename T>
Result<GateEvent> Read(const gate_step_t& step,
                       std::span<const std::uint8_t> bytes) {
  const Result<T> message = bus::Decode<T>(bytes);
  if (!message) return message.error();
  if (message->session != step.event_session ||
      message->seq != step.event_seq) {
    return Error{ErrorCode::kInvalid,
                 "the event's bytes are of another message than the step says"};
  }
  return GateEvent(ToEvent(*message));
}

}  // namespace

JournalEvent InJournal(const MapEvent& event) {
  return {gate_step_t::KIND_MAP, {0, 0, event.map_id}, {}};
}

JournalEvent InJournal(const terra_msg::plan_request_t& message) {
  return AsHeard(gate_step_t::KIND_REQUEST, message);
}

JournalEvent InJournal(const terra_msg::baseline_t& message) {
  return AsHeard(gate_step_t::KIND_BASELINE, message);
}

JournalEvent InJournal(const terra_msg::pose_t& message) {
  return AsHeard(gate_step_t::KIND_POSE, message);
}

JournalEvent InJournal(const AdviceEvent& event) {
  JournalEvent in_journal =
      AsHeard(gate_step_t::KIND_ADVICE, WhatTheGateReads(event));
  in_journal.heard = event.heard;
  return in_journal;
}

std::int64_t DigestOf(const Decisions& decisions) {
  Bytes bytes;
  for (const Decision& decision : decisions) {
    if (const auto* verdict = std::get_if<Verdict>(&decision)) {
      Append(ToMessage(*verdict, 0), bytes);
    } else {
      Append(ToMessage(std::get<Deployed>(decision)), bytes);
    }
  }
  return BytesDigest(bytes);
}

gate_step_t ToStep(const JournalEvent& event, Lookup lookup,
                   std::int64_t now_us, const CoreNames& before,
                   const Decisions& decisions, std::int64_t core_after) {
  gate_step_t step{};
  step.now_us = now_us;
  step.kind = event.kind;
  step.lookup = static_cast<std::int8_t>(lookup);
  step.event_session = event.heard.session;
  step.event_seq = event.heard.seq;
  step.event_digest = event.heard.digest;
  step.request_id = before.request_id;
  step.request_cancelled = before.request_cancelled ? 1 : 0;
  step.answered_by = before.answered_by;
  step.map_id = before.map_id;
  step.baseline_digest = before.baseline_digest;
  step.baseline_session = before.baseline_session;
  step.route_seq = before.route_seq;
  step.place_x = before.place_cell.x;
  step.place_y = before.place_cell.y;
  step.place_index = before.place;
  step.place_on_route = before.on_route ? 1 : 0;
  step.place_speed = std::numeric_limits<double>::quiet_NaN();
  step.place_age_us = -1;
  step.decision = before.decisions;
  step.core_before = before.digest;
  step.num_decisions = static_cast<std::int32_t>(decisions.size());
  step.decisions_digest = DigestOf(decisions);
  step.core_after = core_after;
  step.bytes_digest = BytesDigest({});
  return step;
}

Result<GateEvent> EventOf(const gate_step_t& step,
                          std::span<const std::uint8_t> bytes) {
  switch (step.kind) {
    case gate_step_t::KIND_MAP:
      return GateEvent(MapEvent{nullptr, step.event_digest});
    case gate_step_t::KIND_REQUEST:
      return Read<terra_msg::plan_request_t>(step, bytes);
    case gate_step_t::KIND_BASELINE:
      return Read<terra_msg::baseline_t>(step, bytes);
    case gate_step_t::KIND_ADVICE:
      return Read<advice_t>(step, bytes);
    case gate_step_t::KIND_POSE:
      return Read<terra_msg::pose_t>(step, bytes);
    default:
      return Error{ErrorCode::kInvalid,
                   "a step of kind " + std::to_string(step.kind) +
                       ", which this version does not know"};
  }
}

}  // namespace terra::verifier
