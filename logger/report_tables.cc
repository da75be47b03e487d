#include "logger/report_tables.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <variant>

#include "bus/process_state.h"
#include "logger/report_html.h"
#include "verifier/verify.h"

namespace terra::logger {
namespace {

using terra_msg::deployed_t;
using terra_msg::verdict_t;

constexpr std::size_t kMaxRows = 200;

// A text that may need several lines.
std::string Long(const std::string& style, const std::string& text) {
  if (text.empty()) return {};
  return "<span class=\"long " + style + "\">" + Escape(text) + "</span>";
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

}  // namespace

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

std::string VerdictTable(const LogContents& contents) {
  std::vector<const Logged<LogContents::Decided>*> verdicts =
      contents.DecisionsInOrder();
  std::erase_if(verdicts, [](const auto* logged) {
    return !std::holds_alternative<verdict_t>(logged->message);
  });
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

std::string ProcessTable(const LogContents& contents) {
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
    rows.push_back(
        {Escape(name), Escape(last.host), std::to_string(last.pid),
         std::to_string(process.sessions.size()),
         std::to_string(process.heartbeats),
         Number(process.longest_silence, 1) + " s",
         Long(bus::DoesItsWork(bus::StateOf(last.state)) ? "good" : "bad",
              last.state),
         Long("", last.last_error), Long("", last.build_id)});
  }
  return Table({"process", "host", "pid", "starts", "heartbeats",
                "longest silence", "last state", "last error", "build"},
               rows);
}

std::string AuditTable(const Audit& audit) {
  std::string html = Format(
      "<p>%lld steps of the gate's journal played again, with %lld verdicts "
      "and "
      "%lld deployments, byte for byte the same; %lld times begun from the "
      "state "
      "that the log holds.</p>\n",
      static_cast<long long>(audit.steps),
      static_cast<long long>(audit.verdicts),
      static_cast<long long>(audit.deployed),
      static_cast<long long>(audit.anchors));
  if (!audit.has_journal) {
    html +=
        "<p>This log holds no journal of a gate, so no decision can be made "
        "again.</p>\n";
  }
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

}  // namespace terra::logger
