#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bus/messages.h"

namespace terra::cli {

/// Follows the advisors' heartbeats, to say why no advice came and to see when
/// none is to be waited for: a call that failed sends no verdict.
class AdvisorWatch {
 public:
  /// A heartbeat that was heard after the baseline; other processes' count not.
  void OnStatus(const terra_msg::status_t& status);

  /// True when there are advisors and each has given up: three heartbeats in
  /// succession in which it was idle and its last call had failed. (After the
  /// first it may still hear of the baseline, after the second a verdict may be
  /// on its way.)
  bool AllGaveUp() const;

  /// What is known of one advisor; texts from the bus, made fit for a terminal.
  struct Advisor {
    std::string name;
    std::string state;
    std::string error;
    int idle_heartbeats = 0;
  };
  std::vector<Advisor> advisors() const;

  /// Why the advisor's last answer was none; empty where no heartbeat told.
  std::string ErrorOf(const std::string& name) const;

 private:
  std::map<std::string, Advisor> advisors_;  ///< By name and host.
};

}  // namespace terra::cli
