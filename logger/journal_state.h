#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "logger/log_contents.h"
#include "terrain/result.h"
#include "verifier/gate.h"

namespace terra::logger {

/// Makes the gate that stood before a step: a step names the parts of the core
/// before it, the log holds the messages with these names, and the step's
/// digest proves that the core made of them is the one.
///
/// Errors: kNotFound for what the log does not hold; kInvalid where the parts
/// are no core of this digest.
Result<verifier::Gate> GateBefore(const terra_msg::gate_step_t& step,
                                  const verifier::GateOptions& options,
                                  LogContents& contents);

/// Says what is wrong with the price of what a gate has deployed, which a
/// digest does not prove; nothing where it is right, or where the log lacks the
/// map.
std::optional<std::string> WrongPrice(const verifier::Deployed& deployed,
                                      LogContents& contents);

}  // namespace terra::logger
