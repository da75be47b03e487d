#include "logger/replayed_gate.h"

#include <utility>

namespace terra::logger {

void ReplayedGate::Hear(const GateEvents& events) {
  for (const GateEvent& event : events) {
    std::visit(
        [this](const auto& heard) {
          for (verifier::Decision& decision : gate_.On(heard)) {
            decided_.push_back(std::move(decision));
          }
          Note(heard);
        },
        event);
  }
}

void ReplayedGate::Note(const verifier::RequestEvent& event) {
  if (event.cancel || event.request_id != baseline_.request_id) baseline_ = {};
}

void ReplayedGate::Note(const verifier::BaselineEvent& event) {
  if (event.request_id != deployed().request_id || event.map_id != map_id_) {
    return;  // The gate did not take it.
  }
  baseline_ = event.has_route ? event : verifier::BaselineEvent{};
}

}  // namespace terra::logger
