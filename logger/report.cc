#include "logger/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "bus/codec.h"
#include "logger/audit.h"
#include "logger/log_contents.h"
#include "logger/report_charts.h"
#include "logger/report_html.h"
#include "logger/report_map.h"
#include "verifier/verify.h"

namespace terra::logger {
namespace {

using terra_msg::baseline_t;
using terra_msg::deployed_t;
using terra_msg::verdict_t;

constexpr std::size_t kMaxRows = 200;
constexpr std::size_t kMaxMaps = 6;

constexpr std::string_view kStyle = R"(
:root{--ink:#1b2430;--soft:#5d6b7c;--line:#e3e8ef;--paper:#fff;--back:#f4f6f9}
*{box-sizing:border-box}body{margin:0;background:var(--back);color:var(--ink);
font:15px/1.45 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif}
main{max-width:1220px;margin:0 auto;padding:28px 24px 60px}
h1{font-size:26px;margin:0 0 2px}h2{font-size:18px;margin:0 0 12px}
.sub,.note{color:var(--soft);margin:0 0 18px;overflow-wrap:anywhere}
section{background:var(--paper);border:1px solid var(--line);
border-radius:10px;padding:18px 20px;margin:16px 0}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(150px,1fr));
gap:12px}.card{background:var(--paper);border:1px solid var(--line);
border-radius:10px;padding:12px 14px}.card b{display:block;font-size:24px}
.card span{color:var(--soft);font-size:13px}
.good{color:#0a8f2e}.bad{color:#c62f2f}
svg{width:100%;height:auto;display:block}
svg text{font-family:inherit;fill:var(--ink)}
.label{font-size:13px;text-anchor:end}.tick{font-size:12px;
text-anchor:middle;fill:#5d6b7c}.value{font-size:12.5px;fill:#5d6b7c}
.lane{stroke:#d9dfe8;stroke-width:1}.grid{stroke:#eef1f5;stroke-width:1}
.scroll{overflow-x:auto}table{border-collapse:collapse;width:100%;
font-size:13.5px}th{text-align:left;color:var(--soft);font-weight:600}
th,td{padding:5px 10px 5px 0;border-bottom:1px solid var(--line);
white-space:nowrap}td{font-variant-numeric:tabular-nums}
.maps{display:grid;grid-template-columns:repeat(auto-fill,minmax(340px,1fr));
gap:18px}.map{border:1px solid var(--line);border-radius:6px}
figure{margin:0}figcaption{font-size:13.5px;margin-top:6px;color:var(--soft)}
.key{display:flex;gap:18px;flex-wrap:wrap;font-size:13px;color:var(--soft);
margin-top:8px}.key i{display:inline-block;width:12px;height:12px;
border-radius:3px;margin-right:6px;vertical-align:-1px}
)";

std::string UtcTime(std::int64_t time_us) {
  const std::time_t seconds = time_us / 1'000'000;
  std::tm utc{};
  std::array<char, 64> text{};
  if (gmtime_r(&seconds, &utc) == nullptr ||
      std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", &utc) ==
          0) {
    return "?";
  }
  return text.data();
}

double SecondsBetween(std::int64_t from_us, std::int64_t to_us) {
  return 1e-6 * (static_cast<double>(to_us) - static_cast<double>(from_us));
}

std::string ModeName(std::int8_t mode) {
  constexpr std::array kNames = {"none", "baseline", "candidate", "hold"};
  return mode >= 0 && mode < std::ssize(kNames)
             ? kNames[static_cast<std::size_t>(mode)]
             : "?";
}

std::string Point(int x, int y) {
  return Format("%d, %d", x, y);
}

// What became of one request.
struct RequestStory {
  std::int64_t id = 0;
  std::int64_t asked_us = 0;  // 0 = the log does not have it.
  std::int64_t baseline_us = 0;
  std::int64_t baseline_deployed_us = 0;
  std::int64_t refined_us = 0;
  const deployed_t* last = nullptr;  // That has a route.
  std::int64_t last_us = 0;
  std::int64_t candidates = 0;

  double saving_percent() const {
    return last != nullptr
               ? 100.0 * (last->baseline_cost - last->deployed_cost) /
                     last->baseline_cost
               : std::nan("");
  }
};

std::vector<RequestStory> Stories(const LogContents& contents) {
  std::map<std::int64_t, RequestStory> stories;
  for (const auto& [id, request] : contents.requests) {
    stories[id].asked_us = request.time_us;
  }
  for (const auto& [name, baseline] : contents.baselines) {
    std::int64_t& first = stories[baseline.message.request_id].baseline_us;
    first = first == 0 ? baseline.time_us : std::min(first, baseline.time_us);
  }
  for (const auto& [session, decisions] : contents.decisions) {
    for (const auto& [number, logged] : decisions) {
      const auto* deployed = std::get_if<deployed_t>(&logged.message);
      if (deployed == nullptr || deployed->request_id == 0) continue;
      RequestStory& story = stories[deployed->request_id];
      const bool baseline = deployed->mode == deployed_t::MODE_BASELINE;
      const bool candidate = deployed->mode == deployed_t::MODE_CANDIDATE;
      if (baseline && story.baseline_deployed_us == 0) {
        story.baseline_deployed_us = logged.time_us;
      }
      if (candidate && story.refined_us == 0) story.refined_us = logged.time_us;
      if (candidate) ++story.candidates;
      if ((baseline || candidate) && logged.time_us >= story.last_us) {
        story.last = deployed;
        story.last_us = logged.time_us;
      }
    }
  }
  std::vector<RequestStory> in_order;
  for (auto& [id, story] : stories) {
    story.id = id;
    in_order.push_back(story);
  }
  const auto begin_of = [](const RequestStory& story) {
    return story.asked_us != 0 ? story.asked_us : story.baseline_us;
  };
  std::sort(in_order.begin(), in_order.end(),
            [&](const RequestStory& a, const RequestStory& b) {
              return begin_of(a) < begin_of(b);
            });
  return in_order;
}

std::string Card(const std::string& value, const char* name,
                 const char* style = "") {
  return std::string("<div class=\"card\"><b class=\"") + style + "\">" +
         value + "</b><span>" + name + "</span></div>\n";
}

std::string Section(const char* head, const std::string& content) {
  return std::string("<section><h2>") + head + "</h2>\n" + content +
         "</section>\n";
}

std::string Cards(const LogContents& contents,
                  const std::vector<RequestStory>& stories,
                  const Audit& audit) {
  std::int64_t verdicts = 0;
  std::int64_t accepted = 0;
  for (const auto& [session, decisions] : contents.decisions) {
    for (const auto& [number, logged] : decisions) {
      const auto* verdict = std::get_if<verdict_t>(&logged.message);
      if (verdict == nullptr) continue;
      ++verdicts;
      if (verdict->code == verdict_t::CODE_ACCEPTED) ++accepted;
    }
  }
  double saved = 0;
  std::int64_t served = 0;
  for (const RequestStory& story : stories) {
    if (!std::isfinite(story.saving_percent())) continue;
    saved += story.saving_percent();
    ++served;
  }
  std::string html = "<div class=\"cards\">\n";
  html += Card(std::to_string(stories.size()), "requests");
  html += Card(std::to_string(contents.baselines.size()), "baselines");
  html += Card(std::to_string(contents.advice.size()), "advice heard");
  html += Card(std::to_string(verdicts), "verdicts");
  html += Card(std::to_string(accepted), "accepted", "good");
  html += Card(
      served > 0 ? Number(saved / static_cast<double>(served), 1) + " %" : "-",
      "mean saving, route deployed last");
  html += Card(audit.clean() ? "clean" : std::to_string(audit.num_findings),
               audit.clean() ? "audit" : "audit findings",
               audit.clean() ? "good" : "bad");
  return html + "</div>\n";
}

std::string Key() {
  std::string html = "<div class=\"key\">";
  for (const auto& [color, name] :
       std::vector<std::pair<const char*, const char*>>{
           {"#1f4fe0", "baseline"},
           {"#0a8f2e", "candidate deployed, accepted, alive"},
           {"#d08a00", "retained, not cheaper, not best"},
           {"#c62f2f", "refused, hold, not ready"},
           {"#d5dae2", "no route"}}) {
    html += std::string("<span><i style=\"background:") + color + "\"></i>" +
            name + "</span>";
  }
  return html + "</div>\n";
}

std::string RequestTable(const std::vector<RequestStory>& stories) {
  std::vector<std::vector<std::string>> rows;
  const auto after = [](std::int64_t from_us, std::int64_t to_us) {
    return from_us == 0 || to_us == 0
               ? std::string("-")
               : Duration(std::max(0.0, SecondsBetween(from_us, to_us)));
  };
  const std::size_t first =
      stories.size() > kMaxRows ? stories.size() - kMaxRows : 0;
  for (std::size_t i = first; i < stories.size(); ++i) {
    const RequestStory& story = stories[i];
    const deployed_t* last = story.last;
    rows.push_back(
        {std::to_string(story.id),
         last ? Point(last->start_x, last->start_y) : "-",
         last ? Point(last->goal_x, last->goal_y) : "-",
         last ? Number(last->baseline_cost) : "-",
         last ? Number(last->deployed_cost) : "-",
         Number(story.saving_percent(), 1),
         last ? ModeName(last->mode) + ", " + Escape(last->source) : "none",
         after(story.asked_us, story.baseline_deployed_us),
         after(story.asked_us, story.refined_us)});
  }
  return Table({"request", "start", "goal", "baseline cost", "deployed cost",
                "saving %", "deployed last", "baseline after", "refined after"},
               rows);
}

std::string Maps(LogContents& contents,
                 const std::vector<RequestStory>& stories) {
  std::string html = "<div class=\"maps\">\n";
  std::size_t drawn = 0;
  for (auto story = stories.rbegin();
       story != stories.rend() && drawn < kMaxMaps; ++story) {
    if (story->last == nullptr) continue;
    const deployed_t& last = *story->last;
    const bus::MapPtr map = contents.maps.Find(last.map_id);
    if (!map) continue;
    ++drawn;
    std::vector<DrawnRoute> routes;
    const auto* baseline = contents.FindBaseline(last.baseline_digest, 0);
    if (baseline != nullptr) {
      routes.push_back({bus::WaypointsOf(baseline->message), "#1f4fe0"});
    }
    if (last.mode == deployed_t::MODE_CANDIDATE) {
      routes.push_back({bus::WaypointsOf(last), "#0a8f2e"});
    }
    html += "<figure>" +
            MapFigure(map->map, routes, Cell{last.start_x, last.start_y},
                      Cell{last.goal_x, last.goal_y}) +
            "<figcaption>request " + std::to_string(story->id) + ": baseline " +
            Number(last.baseline_cost) + " (blue), deployed " +
            Number(last.deployed_cost) + " (" +
            (last.mode == deployed_t::MODE_CANDIDATE
                 ? "green, " + Escape(last.source)
                 : std::string("the baseline")) +
            ")</figcaption></figure>\n";
  }
  return drawn > 0 ? html + "</div>\n"
                   : "<p class=\"note\">no route on a complete map</p>\n";
}

std::string Latencies(const LogContents& contents,
                      const std::vector<RequestStory>& stories) {
  Latency asked{"request to baseline deployed", {}};
  Latency baseline{"baseline to deployed", {}};
  Latency refined{"request to refined route", {}};
  Latency model{"advisor's model (T_llm)", {}};
  Latency check{"gate's check (T_det)", {}};
  const auto add = [](Latency& latency, std::int64_t from, std::int64_t to) {
    if (from != 0 && to != 0) {
      latency.seconds.push_back(std::max(0.0, SecondsBetween(from, to)));
    }
  };
  for (const RequestStory& story : stories) {
    add(asked, story.asked_us, story.baseline_deployed_us);
    add(baseline, story.baseline_us, story.baseline_deployed_us);
    add(refined, story.asked_us, story.refined_us);
  }
  for (const auto& [name, advice] : contents.advice) {
    const std::int64_t t_llm_us = advice.front().message.t_llm_us;
    if (t_llm_us > 0) {
      model.seconds.push_back(1e-6 * static_cast<double>(t_llm_us));
    }
  }
  for (const auto& [session, decisions] : contents.decisions) {
    for (const auto& [number, logged] : decisions) {
      const auto* verdict = std::get_if<verdict_t>(&logged.message);
      if (verdict != nullptr) {
        check.seconds.push_back(
            1e-6 *
            static_cast<double>(std::max<std::int64_t>(0, verdict->t_det_us)));
      }
    }
  }
  return LatencyChart({asked, baseline, refined, model, check}) +
         "<p class=\"note\">Between events: as the recorder heard them, on its "
         "own clock.</p>\n";
}

std::string Health(const LogContents& contents) {
  struct Process {
    const terra_msg::status_t* last = nullptr;
    std::set<std::int64_t> sessions;
    std::int64_t heartbeats = 0;
    std::int64_t last_us = 0;
    double longest_silence = 0;
  };
  std::map<std::string, Process> processes;
  for (const auto& status : contents.statuses) {
    if (processes.size() >= kMaxRows &&
        !processes.contains(status.message.status_name)) {
      continue;
    }
    Process& process = processes[status.message.status_name];
    if (process.last != nullptr) {
      process.longest_silence =
          std::max(process.longest_silence,
                   SecondsBetween(process.last_us, status.time_us));
    }
    process.last = &status.message;
    process.last_us = status.time_us;
    ++process.heartbeats;
    process.sessions.insert(status.message.session);
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, process] : processes) {
    const terra_msg::status_t& last = *process.last;
    const bool ready = last.state.starts_with("ready");
    rows.push_back({Escape(name), Escape(last.host), std::to_string(last.pid),
                    std::to_string(process.sessions.size()),
                    std::to_string(process.heartbeats),
                    Number(process.longest_silence, 1) + " s",
                    std::string("<span class=\"") + (ready ? "good" : "bad") +
                        "\">" + Escape(last.state) + "</span>",
                    Escape(last.last_error), Escape(last.build_id)});
  }
  return Table({"process", "host", "pid", "starts", "heartbeats",
                "longest silence", "last state", "last error", "build"},
               rows);
}

std::string Verdicts(const LogContents& contents) {
  std::vector<const Logged<LogContents::Decided>*> verdicts;
  for (const auto& [session, decisions] : contents.decisions) {
    for (const auto& [number, logged] : decisions) {
      if (std::holds_alternative<verdict_t>(logged.message)) {
        verdicts.push_back(&logged);
      }
    }
  }
  std::vector<std::vector<std::string>> rows;
  const std::size_t first =
      verdicts.size() > kMaxRows ? verdicts.size() - kMaxRows : 0;
  for (std::size_t i = first; i < verdicts.size(); ++i) {
    const auto& verdict = std::get<verdict_t>(verdicts[i]->message);
    const bool accepted = verdict.code == verdict_t::CODE_ACCEPTED;
    std::string code(verifier::CodeName(verifier::Code{verdict.code}));
    if (accepted) code = "<span class=\"good\">" + code + "</span>";
    rows.push_back({Format("%.3f s", SecondsBetween(contents.first_us,
                                                    verdicts[i]->time_us)),
                    std::to_string(verdict.decision), Escape(verdict.advisor),
                    verdict.subject == verdict_t::SUBJECT_BASELINE
                        ? "baseline"
                        : std::to_string(verdict.attempt),
                    code, Number(verdict.candidate_cost),
                    Number(verdict.baseline_cost), Number(verdict.cost_to_beat),
                    verdict.fail_segment >= 0
                        ? Format("segment %d at ", verdict.fail_segment) +
                              Point(verdict.fail_x, verdict.fail_y)
                        : ""});
  }
  return Table({"time", "decision", "advisor", "attempt", "verdict",
                "candidate", "baseline", "to beat", "failed"},
               rows);
}

std::string AuditSection(const Audit& audit) {
  std::string html = Format(
      "<p>%lld verdicts and %lld deployments made again from their inputs, "
      "byte for byte the same; %lld taken as the state to begin from.</p>\n",
      static_cast<long long>(audit.verdicts),
      static_cast<long long>(audit.deployed),
      static_cast<long long>(audit.anchors));
  if (audit.clean()) return html;
  std::vector<std::vector<std::string>> rows;
  for (const Finding& finding : audit.findings) {
    if (rows.size() >= kMaxRows) break;
    rows.push_back({KindName(finding.kind),
                    finding.decision != 0 ? std::to_string(finding.decision)
                                          : std::string(),
                    Escape(finding.what)});
  }
  return html + Table({"finding", "decision", "what"}, rows);
}

}  // namespace

std::string MakeReport(const std::string& title, LogReader& reader) {
  SealChecker seals;
  LogContents contents = LogContents::Load(reader, seals);
  const Audit audit = AuditContents(contents, reader, seals);
  const std::vector<RequestStory> stories = Stories(contents);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width\"><title>" +
      Escape(title) + "</title><style>" + std::string(kStyle) +
      "</style></head><body><main>\n";
  html += "<h1>TerraAdvisor run</h1><p class=\"sub\">" + Escape(title) + " | " +
          UtcTime(contents.first_us) + " | " +
          Number(SecondsBetween(contents.first_us, contents.last_us), 1) +
          " s, " + std::to_string(contents.events) + " events</p>\n";
  html += Cards(contents, stories, audit);
  html += Section("Time line", TimeLine(contents) + Key());
  html += Section("Routes", Maps(contents, stories));
  html += Section("Requests", RequestTable(stories));
  html += Section("Latency", Latencies(contents, stories));
  html += Section("Verdicts", Verdicts(contents));
  html += Section("Processes", Health(contents));
  html += Section("Audit", AuditSection(audit));
  return html + "</main></body></html>\n";
}

}  // namespace terra::logger
