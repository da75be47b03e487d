#include "advisor/advice_codec.h"

#include <algorithm>

#include "bus/codec.h"

namespace terra::advisor {
namespace {

using terra_msg::advice_t;

// All but the candidate.
advice_t ToMessage(const AdviceAuthor& author, const AdviceWorker::Job& job,
                   const AdviceAnswer& answer) {
  advice_t message{};
  message.request_id = job.request_id;
  message.map_id = job.map_id;
  message.baseline_digest = job.baseline_digest;
  message.anchor_session = job.anchor.session;
  message.anchor_route_seq = job.anchor.route_seq;
  message.anchor_index = job.anchor.index;
  message.anchor_x = job.anchor.cell.x;
  message.anchor_y = job.anchor.cell.y;
  message.advisor = author.name;
  message.method = author.method;
  message.backend = author.backend;
  // Nobody who reads a log may take it for a model's answer.
  message.model = (answer.simulated ? "SIMULATED " : "") + answer.model;
  message.attempt = job.number;
  message.kind = static_cast<std::int8_t>(answer.kind);
  message.form = static_cast<std::int8_t>(answer.form);
  message.request_hash = answer.request_hash;
  message.answer_text = answer.answer_text;
  message.tokens_in = answer.tokens_in;
  message.tokens_out = answer.tokens_out;
  message.spend_usd = answer.spend_usd;
  message.t_prep_us = answer.t_prep_us;
  message.t_llm_us = answer.t_llm_us;
  message.advice_error = answer.error;
  return message;
}

void PutCandidate(const Candidate& candidate, advice_t& message) {
  message.polished = candidate.polished ? 1 : 0;
  if (candidate.route.size() > bus::kMaxWaypoints) {
    message.kind = advice_t::KIND_MALFORMED;
    message.advice_error = "more than 2048 waypoints";
  } else {
    bus::SetWaypoints(message, candidate.route);
  }
}

}  // namespace

std::vector<advice_t> ToMessages(const AdviceAuthor& author,
                                 const AdviceWorker::Job& job,
                                 const AdviceAnswer& answer) {
  const std::size_t count = std::max<std::size_t>(1, answer.candidates.size());
  std::vector<advice_t> messages(count, ToMessage(author, job, answer));
  for (std::size_t i = 0; i < count; ++i) {
    messages[i].candidate = static_cast<std::int32_t>(i) + 1;
    if (i < answer.candidates.size()) {
      PutCandidate(answer.candidates[i], messages[i]);
    }
  }
  return messages;
}

}  // namespace terra::advisor
