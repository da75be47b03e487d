#pragma once

#include <cstdint>
#include <vector>

#include "logger/log_contents.h"

namespace terra::logger {

/// What became of one request; a time of 0 = not in the log.
struct RequestStory {
  std::int64_t id = 0;
  std::int64_t asked_us = 0;
  std::int64_t baseline_us = 0;
  std::int64_t baseline_deployed_us = 0;
  std::int64_t refined_us = 0;
  const terra_msg::deployed_t* last = nullptr;  ///< That has a route.
  std::int64_t last_us = 0;
  std::int64_t candidates = 0;

  double saving_percent() const;  ///< NaN without a route.
};

/// In the order in which they were asked. Points into the contents.
std::vector<RequestStory> Stories(const LogContents& contents);

double SecondsBetween(std::int64_t from_us, std::int64_t to_us);

}  // namespace terra::logger
