#include "logger/report.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/utc.h"
#include "bus/codec.h"
#include "logger/audit.h"
#include "logger/log_contents.h"
#include "logger/report_charts.h"
#include "logger/report_html.h"
#include "logger/report_latencies.h"
#include "logger/report_map.h"
#include "logger/report_stories.h"
#include "logger/report_tables.h"

namespace terra::logger {
namespace {

using terra_msg::deployed_t;
using terra_msg::verdict_t;

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
white-space:nowrap}td{font-variant-numeric:tabular-nums}.long{display:inline-block;
white-space:normal;overflow-wrap:anywhere;min-width:120px;max-width:330px}
.maps{display:grid;grid-template-columns:repeat(auto-fill,minmax(340px,1fr));
gap:18px}.map{border:1px solid #b9c2ce;border-radius:4px}
figure{margin:0}figcaption{font-size:13.5px;margin-top:6px;color:var(--soft)}
.key{display:flex;gap:18px;flex-wrap:wrap;font-size:13px;color:var(--soft);
margin-top:8px}.key i{display:inline-block;width:12px;height:12px;
border-radius:3px;margin-right:6px;vertical-align:-1px;
border:1px solid #0002}
)";

std::string UtcTime(std::int64_t time_us) {
  const std::string text =
      FormatUtc(time_us / 1'000'000, "%Y-%m-%d %H:%M:%S UTC");
  return text.empty() ? "?" : text;
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
  std::vector<double> savings;
  for (const RequestStory& story : stories) {
    if (std::isfinite(story.saving_percent())) {
      savings.push_back(story.saving_percent());
    }
  }
  std::sort(savings.begin(), savings.end());
  std::string html = "<div class=\"cards\">\n";
  html += Card(std::to_string(stories.size()), "requests");
  html += Card(std::to_string(contents.baselines.size()), "baselines");
  html += Card(std::to_string(contents.advice.size()), "advice heard");
  html += Card(std::to_string(verdicts), "verdicts");
  html += Card(std::to_string(accepted), "accepted", "good");
  html += Card(
      savings.empty() ? "-" : Number(savings[savings.size() / 2], 1) + " %",
      "median saving, route deployed last");
  html += Card(
      audit.clean() ? Conclusion(audit) : std::to_string(audit.num_findings),
      audit.clean() ? "audit" : "audit findings",
      audit.passed() ? "good" : "bad");
  if (audit.unrecorded > 0) {
    html +=
        Card(std::to_string(audit.unrecorded),
             "decisions not made again (left out of the journal in a flood)");
  }
  return html + "</div>\n";
}

std::string Maps(LogContents& contents,
                 const std::vector<RequestStory>& stories) {
  std::string html = "<div class=\"maps\">\n";
  std::vector<const RequestStory*> routed;
  for (const RequestStory& story : stories) {
    if (story.last != nullptr) routed.push_back(&story);
  }
  if (routed.size() > kMaxMaps) {
    routed.erase(routed.begin(), routed.end() - kMaxMaps);
  }
  bus::MapPtr drawn;
  for (const RequestStory* story : routed) {
    const deployed_t& last = *story->last;
    const bus::MapPtr map = contents.maps.Find(last.map_id);
    if (!map) continue;
    drawn = map;
    std::vector<DrawnRoute> routes;
    const auto* baseline = contents.FindBaseline(last.baseline_digest, 0);
    if (baseline != nullptr) {
      routes.push_back({bus::WaypointsOf(baseline->message), kBaselineColor});
    }
    if (last.mode == deployed_t::MODE_CANDIDATE) {
      routes.push_back({bus::WaypointsOf(last), kCandidateColor});
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
  if (!drawn) return "<p class=\"note\">no route on a complete map</p>\n";
  return html + "</div>\n" + TerrainKey(drawn->map);
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
  html += Section("Time line", TimeLine(contents) + TimeLineKey());
  html += Section("Routes", Maps(contents, stories));
  html += Section("Requests", RequestTable(stories));
  html += Section("Latency", LatencySection(LatenciesOf(contents, stories)));
  html += Section("Verdicts", VerdictTable(contents));
  html += Section("Processes", ProcessTable(contents));
  html += Section("Audit", AuditTable(audit));
  return html + "</main></body></html>\n";
}

}  // namespace terra::logger
