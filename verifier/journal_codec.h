#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "bus/messages.h"
#include "terrain/result.h"
#include "verifier/gate_core.h"
#include "verifier/gate_messages.h"

/// The steps of the gate's journal as messages: what the gate writes, and what
/// an audit or a replay reads.
namespace terra::verifier {

/// What a gate takes.
using GateEvent =
    std::variant<MapEvent, RequestEvent, BaselineEvent, AdviceEvent, PoseEvent>;

using Bytes = std::vector<std::uint8_t>;

/// An event as the journal has it: who said it, and its bytes.
struct JournalEvent {
  std::int8_t kind = terra_msg::gate_step_t::KIND_NONE;
  HeardMessage heard;  ///< Of a map, the digest is its id.
  Bytes bytes;         ///< Empty for a map.
};

JournalEvent InJournal(const MapEvent& event);
JournalEvent InJournal(const terra_msg::plan_request_t& message);
JournalEvent InJournal(const terra_msg::baseline_t& message);
JournalEvent InJournal(const terra_msg::pose_t& message);
/// Of advice, what the gate reads, so that no answer of a model makes a journal
/// large.
JournalEvent InJournal(const AdviceEvent& event);

/// Returns XXH3-64 of the messages of these decisions one after another, what
/// each sending of them changes being 0.
std::int64_t DigestOf(const Decisions& decisions);

/// Makes a step without number and bytes.
terra_msg::gate_step_t ToStep(const JournalEvent& event, Lookup lookup,
                              std::int64_t now_us, const CoreNames& before,
                              const Decisions& decisions,
                              std::int64_t core_after);

/// Reads the event of a step from bytes: those of the step, or those of the
/// message itself where the step has none. A map is only named, its `map` is
/// null. Errors: bytes that are no such message, or of another sender than the
/// step says; a kind that this version does not know.
Result<GateEvent> EventOf(const terra_msg::gate_step_t& step,
                          std::span<const std::uint8_t> bytes);

}  // namespace terra::verifier
