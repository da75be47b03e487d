#include "logger/report_stories.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <variant>

namespace terra::logger {

using terra_msg::deployed_t;

double SecondsBetween(std::int64_t from_us, std::int64_t to_us) {
  return 1e-6 * (static_cast<double>(to_us) - static_cast<double>(from_us));
}

double RequestStory::saving_percent() const {
  return last != nullptr ? 100.0 * (last->baseline_cost - last->deployed_cost) /
                               last->baseline_cost
                         : std::nan("");
}

namespace {

// Requests of the state that a part begins with: what is said of them there
// was said before, nobody knows when.
std::set<std::int64_t> AskedBefore(const LogContents& contents) {
  std::set<std::int64_t> ids;
  const auto add = [&](const auto& logged) {
    if (logged.index < contents.state_end) {
      ids.insert(logged.message.request_id);
    }
  };
  for (const auto& [id, request] : contents.requests) add(request);
  for (const auto& [name, baseline] : contents.baselines) add(baseline);
  return ids;
}

}  // namespace

std::vector<RequestStory> Stories(const LogContents& contents) {
  std::map<std::int64_t, RequestStory> stories;
  for (const auto& [id, request] : contents.requests) {
    stories[id].asked_us = request.time_us;
  }
  for (const auto& [name, baseline] : contents.baselines) {
    std::int64_t& first = stories[baseline.message.request_id].baseline_us;
    first = first == 0 ? baseline.time_us : std::min(first, baseline.time_us);
  }
  // A gate that was killed and its successor both deploy for a request: what
  // came first counts, whatever their sessions.
  for (const auto* logged : contents.DecisionsInOrder()) {
    const auto* deployed = std::get_if<deployed_t>(&logged->message);
    if (deployed == nullptr || deployed->request_id == 0) continue;
    RequestStory& story = stories[deployed->request_id];
    const bool baseline = deployed->mode == deployed_t::MODE_BASELINE;
    const bool candidate = deployed->mode == deployed_t::MODE_CANDIDATE;
    if (baseline && story.baseline_deployed_us == 0) {
      story.baseline_deployed_us = logged->time_us;
    }
    if (candidate && story.refined_us == 0) story.refined_us = logged->time_us;
    if (candidate) ++story.candidates;
    if (baseline || candidate) {
      story.last = deployed;
      story.last_us = logged->time_us;
    }
  }
  for (const std::int64_t id : AskedBefore(contents)) {
    RequestStory& story = stories[id];
    story.asked_us = story.baseline_us = 0;
    story.baseline_deployed_us = story.refined_us = 0;
  }
  std::vector<RequestStory> in_order;
  for (auto& [id, story] : stories) {
    story.id = id;
    in_order.push_back(story);
  }
  const auto begin_of = [](const RequestStory& story) {
    return story.asked_us != 0 ? story.asked_us : story.baseline_us;
  };
  // At one time, by number: the order in which the map has them.
  std::stable_sort(in_order.begin(), in_order.end(),
                   [&](const RequestStory& a, const RequestStory& b) {
                     return begin_of(a) < begin_of(b);
                   });
  return in_order;
}

}  // namespace terra::logger
