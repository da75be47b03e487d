#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "logger/log_contents.h"
#include "logger/report_charts.h"
#include "logger/report_stories.h"

namespace terra::logger {

/// A sender some of whose figures cannot be true.
struct ImpossibleClaims {
  std::string who;
  std::int64_t impossible = 0;
  std::int64_t all = 0;
};

/// The latencies of a run, by who knows them.
struct RunLatencies {
  /// Between events, as the recorder heard them: true whatever anybody says.
  std::vector<Latency> measured;
  /// What senders say of themselves: a row for each, so that one who lies
  /// spoils no other's. Figures that are negative or longer than what passed
  /// are not in here.
  std::vector<Latency> claimed;
  std::vector<ImpossibleClaims> impossible;
  /// Senders beyond the first kMaxClaimants, which have no row.
  std::size_t left_out = 0;

  static constexpr std::size_t kMaxClaimants = 12;
};

RunLatencies LatenciesOf(const LogContents& contents,
                         const std::vector<RequestStory>& stories);

/// The section of the page.
std::string LatencySection(const RunLatencies& latencies);

}  // namespace terra::logger
