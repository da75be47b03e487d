#include "logger/report_charts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bus/process_state.h"
#include "logger/report_html.h"
#include "verifier/verify.h"

namespace terra::logger {
namespace {

using terra_msg::deployed_t;
using terra_msg::verdict_t;

constexpr double kWidth = 1120;
constexpr double kLabels = 150;  // Left of the plot.
constexpr double kRight = 30;    // Right of it, for half of the last label.
constexpr double kLane = 26;
constexpr std::size_t kMaxMarks = 3'000;  // Of one lane.
constexpr std::size_t kMaxLanes = 12;     // Of advisors, of processes.

const char* ModeColor(std::int8_t mode) {
  switch (mode) {
    case deployed_t::MODE_BASELINE:
      return kBaselineColor;
    case deployed_t::MODE_CANDIDATE:
      return kCandidateColor;
    case deployed_t::MODE_HOLD:
      return kBadColor;
    default:
      return kNoRouteColor;
  }
}

const char* VerdictColor(std::int16_t code) {
  if (code == verdict_t::CODE_ACCEPTED) return kCandidateColor;
  if (code == verdict_t::CODE_RETAINED || code == verdict_t::CODE_NOT_BEST ||
      code == verdict_t::CODE_NOT_CHEAPER) {
    return kNoGainColor;
  }
  return kBadColor;
}

// The next of 1, 2, 5, 10, ... from a number on.
double RoundStep(double at_least) {
  const double decade = std::pow(10.0, std::floor(std::log10(at_least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= at_least) return factor * decade;
  }
  return 10 * decade;
}

// Lays lanes below each other and draws marks into them.
class Lanes {
 public:
  Lanes(std::int64_t first_us, std::int64_t last_us)
      : first_us_(first_us),
        span_us_(std::max<double>(1.0, static_cast<double>(last_us) -
                                           static_cast<double>(first_us))) {}

  void Begin(const std::string& name) {
    y_ += kLane;
    marks_ = 0;
    svg_ += Format(
        "<line x1=\"%.0f\" x2=\"%.0f\" y1=\"%.1f\" y2=\"%.1f\" "
        "class=\"lane\"/>",
        kLabels, kWidth, y_, y_);
    svg_ += Format("<text x=\"%.0f\" y=\"%.1f\" class=\"label\">", kLabels - 10,
                   y_ + 4) +
            Escape(name) + "</text>\n";
  }
  void Dot(std::int64_t time_us, const char* color, const std::string& title) {
    if (++marks_ > kMaxMarks) return;
    svg_ += Format(
                "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" fill=\"%s\" "
                "stroke=\"#fff\"><title>",
                X(time_us), y_, color) +
            Escape(title) + "</title></circle>\n";
  }
  void Tick(std::int64_t time_us, const char* color) {
    if (++marks_ > kMaxMarks) return;
    svg_ += Format(
        "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\" "
        "stroke=\"%s\" stroke-width=\"2\"/>",
        X(time_us), X(time_us), y_ - 5, y_ + 5, color);
  }
  void Bar(std::int64_t from_us, std::int64_t to_us, const char* color,
           const std::string& title) {
    if (++marks_ > kMaxMarks) return;
    svg_ +=
        Format(
            "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"14\" "
            "rx=\"2\" fill=\"%s\"><title>",
            X(from_us), y_ - 7, std::max(1.5, X(to_us) - X(from_us)), color) +
        Escape(title) + "</title></rect>\n";
  }
  std::string Finish() {
    const double bottom = y_ + kLane;
    const double span_s = 1e-6 * span_us_;
    const double step = RoundStep(span_s / 8);
    const int decimals = step < 0.1 ? 2 : step < 1 ? 1 : 0;
    std::string axis;
    for (int i = 0; i * step <= span_s; ++i) {
      const double x =
          kLabels + (kWidth - kRight - kLabels) * i * step / span_s;
      axis += Format(
          "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"10\" y2=\"%.1f\" "
          "class=\"grid\"/><text x=\"%.1f\" y=\"%.1f\" "
          "class=\"tick\">%.*f s</text>\n",
          x, x, bottom - 8, x, bottom + 8, decimals, i * step);
    }
    return Format("<svg viewBox=\"0 0 %.0f %.0f\" role=\"img\">", kWidth,
                  bottom + 18) +
           axis + svg_ + "</svg>\n";
  }

 private:
  double X(std::int64_t time_us) const {
    const double at =
        (static_cast<double>(time_us) - static_cast<double>(first_us_)) /
        span_us_;
    return kLabels + std::clamp(at, 0.0, 1.0) * (kWidth - kRight - kLabels);
  }

  std::int64_t first_us_;
  double span_us_;
  double y_ = 0;
  std::size_t marks_ = 0;
  std::string svg_;
};

void DrawAdvice(const LogContents& contents, Lanes& lanes) {
  std::map<std::string, std::vector<const Logged<terra_msg::advice_t>*>>
      by_name;
  for (const auto& [name, advice] : contents.advice) {
    const std::string& advisor = advice.front().message.advisor;
    if (by_name.size() < kMaxLanes || by_name.contains(advisor)) {
      by_name[advisor].push_back(&advice.front());
    }
  }
  for (const auto& [name, all] : by_name) {
    lanes.Begin("advice: " + name);
    for (const auto* advice : all) {
      const bool proposes =
          advice->message.kind == terra_msg::advice_t::KIND_PROPOSE;
      lanes.Dot(advice->time_us, proposes ? kAdviceColor : kMutedColor,
                Format("attempt %lld, %d waypoints",
                       static_cast<long long>(advice->message.attempt),
                       advice->message.num_waypoints));
    }
  }
}

void DrawDecisions(const LogContents& contents, Lanes& lanes) {
  lanes.Begin("verdicts");
  const auto decisions = contents.DecisionsInOrder();
  for (const auto* logged : decisions) {
    const auto* verdict = std::get_if<verdict_t>(&logged->message);
    if (verdict == nullptr) continue;
    lanes.Dot(
        logged->time_us, VerdictColor(verdict->code),
        verdict->advisor + ": " +
            std::string(verifier::CodeName(verifier::Code{verdict->code})));
  }
  lanes.Begin("deployed");
  // What a gate deploys ends what any gate deployed before: the robot follows
  // the newest.
  const Logged<LogContents::Decided>* open = nullptr;
  const auto close = [&](std::int64_t end_us) {
    if (open == nullptr) return;
    const auto& deployed = std::get<deployed_t>(open->message);
    lanes.Bar(open->time_us, end_us, ModeColor(deployed.mode),
              "route " + std::to_string(deployed.route_seq) + ", cost " +
                  Number(deployed.deployed_cost) + ", " + deployed.source);
  };
  for (const auto* logged : decisions) {
    if (!std::holds_alternative<deployed_t>(logged->message)) continue;
    close(logged->time_us);
    open = logged;
  }
  close(contents.last_us);
}

void DrawHeartbeats(const LogContents& contents, Lanes& lanes) {
  std::map<std::string, std::vector<const Logged<terra_msg::status_t>*>>
      by_name;
  for (const auto& status : contents.statuses) {
    if (by_name.size() < kMaxLanes ||
        by_name.contains(status.message.status_name)) {
      by_name[status.message.status_name].push_back(&status);
    }
  }
  for (const auto& [name, all] : by_name) {
    lanes.Begin(name + " alive");
    for (const auto* status : all) {
      lanes.Tick(status->time_us,
                 bus::DoesItsWork(bus::StateOf(status->message.state))
                     ? kCandidateColor
                     : kBadColor);
    }
  }
}

// "10 ms" for -2.
std::string PowerOfTen(double exponent) {
  const int unit = exponent < -3 ? -6 : exponent < 0 ? -3 : 0;
  return Format("%.0f %s", std::pow(10.0, exponent - unit),
                unit == -6   ? "&micro;s"
                : unit == -3 ? "ms"
                             : "s");
}

double Quantile(const std::vector<double>& sorted, double part) {
  const double at = part * static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::lround(at))];
}

}  // namespace

std::string TimeLineKey() {
  return Key({{kRequestColor, "request"},
              {kBaselineColor, "baseline"},
              {kAdviceColor, "advice"},
              {kCandidateColor, "accepted, candidate deployed, alive"},
              {kNoGainColor, "retained, not cheaper, not best"},
              {kBadColor, "refused, hold, not ready"},
              {kNoRouteColor, "no route"}});
}

std::string TimeLine(const LogContents& contents) {
  Lanes lanes(contents.first_us, contents.last_us);
  lanes.Begin("requests");
  for (const auto& [id, request] : contents.requests) {
    lanes.Dot(request.time_us, kRequestColor, "request " + std::to_string(id));
  }
  for (const auto& [id, cancel] : contents.cancels) {
    lanes.Dot(cancel.time_us, kBadColor, "cancel " + std::to_string(id));
  }
  lanes.Begin("baselines");
  for (const auto& [name, baseline] : contents.baselines) {
    lanes.Dot(baseline.time_us, kBaselineColor,
              baseline.message.planner + ", cost " +
                  Number(baseline.message.baseline_cost));
  }
  DrawAdvice(contents, lanes);
  DrawDecisions(contents, lanes);
  DrawHeartbeats(contents, lanes);
  return lanes.Finish();
}

std::string LatencyChart(std::vector<Latency> latencies) {
  std::erase_if(latencies, [](const Latency& latency) {
    return latency.seconds.empty();
  });
  if (latencies.empty()) return "<p class=\"note\">nothing measured</p>\n";
  double low = 1e-4;
  double high = 1e-3;
  for (Latency& latency : latencies) {
    for (double& value : latency.seconds) value = std::max(value, 1e-6);
    std::sort(latency.seconds.begin(), latency.seconds.end());
    low = std::min(low, latency.seconds.front());
    high = std::max(high, latency.seconds.back());
  }
  const double first = std::floor(std::log10(low));
  const double last = std::ceil(std::log10(high));
  constexpr double kLeft = 210;
  constexpr double kEnd = 830;
  const auto x = [&](double value) {
    return kLeft +
           (std::log10(value) - first) / (last - first) * (kEnd - kLeft);
  };
  const double bottom = 34 * static_cast<double>(latencies.size()) + 12;
  std::string svg = Format("<svg viewBox=\"0 0 %.0f %.0f\" role=\"img\">",
                           kWidth, bottom + 24);
  for (double decade = first; decade <= last; ++decade) {
    const double at = x(std::pow(10.0, decade));
    svg += Format(
        "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"6\" y2=\"%.1f\" "
        "class=\"grid\"/><text x=\"%.1f\" y=\"%.1f\" "
        "class=\"tick\">%s</text>\n",
        at, at, bottom, at, bottom + 16, PowerOfTen(decade).c_str());
  }
  double y = -6;
  for (const Latency& latency : latencies) {
    y += 34;
    const std::vector<double>& values = latency.seconds;
    svg += Format("<text x=\"%.0f\" y=\"%.1f\" class=\"label\">", kLeft - 12,
                  y + 4) +
           Escape(latency.name) + "</text>";
    const std::size_t step = values.size() / kMaxMarks + 1;
    for (std::size_t i = 0; i < values.size(); i += step) {
      svg += Format(
          "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\" "
          "fill-opacity=\"0.45\"/>",
          x(values[i]), y, kBaselineColor);
    }
    const double median = Quantile(values, 0.5);
    svg += Format(
        "<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.1f\" y2=\"%.1f\" "
        "stroke=\"#111\" stroke-width=\"2\"/>",
        x(median), x(median), y - 9, y + 9);
    svg += Format(
        "<text x=\"%.0f\" y=\"%.1f\" class=\"value\">median %s, p99 "
        "%s, n=%zu</text>\n",
        kEnd + 14, y + 4, Duration(median).c_str(),
        Duration(Quantile(values, 0.99)).c_str(), values.size());
  }
  return svg + "</svg>\n";
}

}  // namespace terra::logger
