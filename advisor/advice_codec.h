#pragma once

#include <string>
#include <vector>

#include "advisor/advice_worker.h"
#include "advisor/backend.h"
#include "bus/messages.h"

namespace terra::advisor {

/// Who gives advice, and how.
struct AdviceAuthor {
  std::string name;
  std::string method;
  std::string backend;
};

/// Returns what goes on the bus for an answer: one message a candidate, at
/// least one. Texts stand in it as they came; the outbox cleans them.
std::vector<terra_msg::advice_t> ToMessages(const AdviceAuthor& author,
                                            const AdviceWorker::Job& job,
                                            const AdviceAnswer& answer);

}  // namespace terra::advisor
