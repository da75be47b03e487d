#pragma once

#include <string>
#include <vector>

#include "logger/log_contents.h"

namespace terra::logger {

/// Charts as inline SVG.

/// What happened when: a lane each for requests, baselines, every advisor,
/// verdicts and what was deployed, then one for the heartbeats of each process.
std::string TimeLine(const LogContents& contents);
/// What its colours mean.
std::string TimeLineKey();

/// One quantity.
struct Latency {
  std::string name;
  std::vector<double> seconds;
};

/// For each quantity a strip of all its values on a common logarithmic axis,
/// with median and 99th percentile.
std::string LatencyChart(std::vector<Latency> latencies);

}  // namespace terra::logger
