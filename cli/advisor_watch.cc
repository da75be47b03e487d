#include "cli/advisor_watch.h"

#include <algorithm>

#include "bus/process_state.h"
#include "cli/output.h"
#include "cli/status_counter.h"

namespace terra::cli {
namespace {

// Names come from the bus: a flood of made-up ones must not fill the memory.
constexpr std::size_t kMaxAdvisors = 64;
constexpr std::size_t kLongestName = 63;
constexpr std::size_t kLongestText = 400;
constexpr int kEnoughHeartbeats = 3;

}  // namespace

void AdvisorWatch::OnStatus(const terra_msg::status_t& status) {
  const std::string key = status.status_name + "@" + status.host;
  if (!CounterOf(status, "jobs") ||
      (advisors_.size() >= kMaxAdvisors && !advisors_.contains(key))) {
    return;
  }
  Advisor& advisor = advisors_[key];
  advisor.name = Printable(status.status_name, kLongestName);
  advisor.state = Printable(status.state, kLongestText);
  advisor.error = Printable(status.last_error, kLongestText);
  const bus::ProcessState state = bus::StateOf(status.state);
  const bool idle = state == bus::ProcessState::kReady ||
                    state == bus::ProcessState::kFailing;
  const bool failed = CounterOf(status, "failures").value_or(0) > 0 &&
                      !status.last_error.empty();
  advisor.idle_heartbeats = idle && failed ? advisor.idle_heartbeats + 1 : 0;
}

bool AdvisorWatch::AllGaveUp() const {
  return !advisors_.empty() &&
         std::all_of(advisors_.begin(), advisors_.end(), [](const auto& entry) {
           return entry.second.idle_heartbeats >= kEnoughHeartbeats;
         });
}

std::string AdvisorWatch::ErrorOf(const std::string& name) const {
  const std::string printable = Printable(name, kLongestName);
  for (const auto& [key, advisor] : advisors_) {
    if (advisor.name == printable) return advisor.error;
  }
  return "";
}

std::vector<AdvisorWatch::Advisor> AdvisorWatch::advisors() const {
  std::vector<Advisor> all;
  for (const auto& [key, advisor] : advisors_) all.push_back(advisor);
  return all;
}

}  // namespace terra::cli
