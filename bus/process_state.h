#pragma once

#include <string_view>

namespace terra::bus {

/// What the state of a STATUS message says, as far as others decide by it. The
/// text may go on behind the word: "failing: cannot write ...".
enum class ProcessState {
  kReady,    ///< Does its work, or would if there were any.
  kWaiting,  ///< Is ready, and works as soon as something has happened.
  kWorking,  ///< Is at it now.
  kFailing,  ///< Cannot do it.
  kOther,    ///< Waits for something, or says what this program does not know.
};

/// The one place that reads states from their text.
constexpr ProcessState StateOf(std::string_view text) {
  const std::string_view word = text.substr(0, text.find_first_of(" :,"));
  if (text.starts_with("ready: waiting")) return ProcessState::kWaiting;
  if (word == "ready") return ProcessState::kReady;
  if (word == "working") return ProcessState::kWorking;
  if (word == "failing") return ProcessState::kFailing;
  return ProcessState::kOther;
}

/// Whether a process in this state does its work.
constexpr bool DoesItsWork(ProcessState state) {
  return state == ProcessState::kReady || state == ProcessState::kWaiting ||
         state == ProcessState::kWorking;
}

}  // namespace terra::bus
