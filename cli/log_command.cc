#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/log_info_output.h"
#include "cli/output.h"
#include "logger/audit.h"
#include "logger/log_info.h"
#include "logger/log_reader.h"
#include "logger/log_rebase.h"
#include "logger/report.h"
#include "output/output_file.h"

namespace terra::cli {
namespace {

// Opens a log in which there is something. Errors: also that there is not.
Result<logger::LogReader> OpenWithEvents(const std::string& path) {
  Result<logger::LogReader> probe = logger::LogReader::Open(path);
  if (!probe) return probe.error();
  if (!probe->Next()) {
    return Error{ErrorCode::kInvalid,
                 path + " holds no events; is it an LCM event log?"};
  }
  return logger::LogReader::Open(path);
}

struct InfoArguments {
  std::string file;
  bool json = false;
};

int RunInfo(const InfoArguments& arguments) {
  Result<logger::LogReader> reader = logger::LogReader::Open(arguments.file);
  if (!reader) return Fail(reader.error());
  const logger::LogInfo info = logger::Inspect(*reader);
  if (arguments.json) {
    PrintLogInfoJson(info, std::cout);
  } else {
    PrintLogInfo(info, std::cout);
  }
  if (info.events == 0) {
    return Fail({ErrorCode::kInvalid, arguments.file + " holds no events"});
  }
  return info.intact() ? kDone : kCouldNot;
}

void AddInfo(CLI::App& log, int& exit_code) {
  CLI::App& command = *log.add_subcommand(
      "info",
      "Show channels, counts, rates, gaps and damage; exit 1 if there is any");
  const auto arguments = std::make_shared<InfoArguments>();
  command.add_option("file", arguments->file, "LCM event log")->required();
  command.add_flag("--json", arguments->json, "Print JSON");
  command.footer(
      "Example:\n  terra log info "
      "log/terra-20260131T120000Z-0123abcd.000.lcmlog");
  command.callback([arguments, &exit_code] {
    exit_code = RunInfo(*arguments);
  });
}

struct AuditArguments {
  std::string file;
  bool json = false;
};

std::string ConclusionLine(const logger::Audit& audit) {
  const std::string conclusion = logger::Conclusion(audit);
  if (!audit.clean()) return conclusion;
  if (!audit.made_any_again()) {
    if (audit.has_journal || audit.sessions.empty()) {
      return conclusion + ": no decision of a gate was made again";
    }
    return conclusion +
           ": this log holds decisions of a gate and no step of its journal "
           "(TERRA_GATE_STEP), by which they are made again. The gate sends it "
           "to the deployed port plus two: is gate or recorder of an older "
           "version, or kept from that port? A gate that does nothing new "
           "writes no step";
  }
  if (!audit.closed) {
    return conclusion +
           ": what is there is right, but the log has no end (cut, or still "
           "being written)";
  }
  if (audit.unrecorded == 0) return conclusion;
  return conclusion + ", but for " + std::to_string(audit.unrecorded) +
         " decisions not made again";
}

void PrintAudit(const logger::Audit& audit) {
  std::cout << audit.steps << " steps of the journal played again, with "
            << audit.verdicts << " verdicts and " << audit.deployed
            << " deployments, the same; " << audit.anchors
            << " times begun from the state that the log holds\n";
  for (const std::int64_t session : audit.sessions) {
    std::cout << "session of the gate: " << session << "\n";
  }
  if (audit.unchecked > 0) {
    std::cout
        << audit.unchecked
        << " decisions not checked: the log does not hold the state before "
           "them, their step or their message\n";
  }
  if (audit.lookups_given > 0) {
    std::cout << audit.lookups_given
              << " times what the gate remembered of advice was taken as the "
                 "journal has it, since it is from before this log\n";
  }
  if (audit.unrecorded > 0) {
    std::cout
        << audit.unrecorded
        << " decisions are on messages that the gate left out of its "
           "journal, to keep it within 1 MB a second,\n"
           "  and that the recorder did not hear either. This is no fault "
           "of the gate, and no route was deployed\n"
           "  unseen: each DEPLOYED that is gone on from was priced "
           "again.\n";
  }
  for (const std::string& note : audit.notes) {
    std::cout << "note: " << note << "\n";
  }
  for (const logger::Finding& finding : audit.findings) {
    std::cout << logger::KindName(finding.kind);
    if (finding.decision != 0) std::cout << ", decision " << finding.decision;
    std::cout << ": " << finding.what << "\n";
  }
  std::cout << ConclusionLine(audit) << "\n";
}

void PrintAuditJson(const logger::Audit& audit) {
  nlohmann::json findings = nlohmann::json::array();
  for (const logger::Finding& finding : audit.findings) {
    findings.push_back({{"kind", logger::KindName(finding.kind)},
                        {"session", finding.session},
                        {"decision", finding.decision},
                        {"what", finding.what}});
  }
  const nlohmann::json all = {{"clean", audit.clean()},
                              {"closed", audit.closed},
                              {"conclusion", logger::Conclusion(audit)},
                              {"sessions", audit.sessions},
                              {"verdicts", audit.verdicts},
                              {"deployed", audit.deployed},
                              {"anchors", audit.anchors},
                              {"unchecked", audit.unchecked},
                              {"unrecorded", audit.unrecorded},
                              {"steps", audit.steps},
                              {"lookups_given", audit.lookups_given},
                              {"has_journal", audit.has_journal},
                              {"notes", audit.notes},
                              {"num_findings", audit.num_findings},
                              {"findings", findings}};
  std::cout << all.dump(2, ' ', false, nlohmann::json::error_handler_t::replace)
            << "\n";
}

int RunAudit(const AuditArguments& arguments) {
  Result<logger::LogReader> reader = OpenWithEvents(arguments.file);
  if (!reader) return Fail(reader.error());
  const logger::Audit audit = logger::AuditLog(*reader);
  if (arguments.json) {
    PrintAuditJson(audit);
  } else {
    PrintAudit(audit);
  }
  return audit.passed() ? kDone : kCouldNot;
}

void AddAudit(CLI::App& log, int& exit_code) {
  CLI::App& command = *log.add_subcommand(
      "audit",
      "Make every verdict and deployment again from the gate's journal and "
      "compare; exit 1 if anything differs or is missing, if the log was not "
      "closed, or if there is nothing to audit (no journal, no decision). What "
      "the gate left out of its journal in a flood is counted and is no "
      "finding");
  const auto arguments = std::make_shared<AuditArguments>();
  command.add_option("file", arguments->file, "LCM event log")->required();
  command.add_flag("--json", arguments->json, "Print JSON");
  command.footer(
      "Example:\n  terra log audit "
      "log/terra-20260131T120000Z-0123abcd.000.lcmlog");
  command.callback([arguments, &exit_code] {
    exit_code = RunAudit(*arguments);
  });
}

struct ReportArguments {
  std::string file;
  std::string out;
};

int RunReport(const ReportArguments& arguments) {
  Result<logger::LogReader> reader = OpenWithEvents(arguments.file);
  if (!reader) return Fail(reader.error());
  const std::string page = logger::MakeReport(arguments.file, *reader);
  const Status written = WriteWholeFile(arguments.out, page);
  return written ? kDone : Fail(written.error());
}

void AddReport(CLI::App& log, int& exit_code) {
  CLI::App& command = *log.add_subcommand(
      "report",
      "Write one HTML page about a log: time line, routes, latencies");
  const auto arguments = std::make_shared<ReportArguments>();
  command.add_option("file", arguments->file, "LCM event log")->required();
  command.add_option("--out", arguments->out, "HTML file")->required();
  command.footer(
      "Example:\n  terra log report "
      "log/terra-20260131T120000Z-0123abcd.000.lcmlog --out run.html");
  command.callback([arguments, &exit_code] {
    exit_code = RunReport(*arguments);
  });
}

struct RebaseArguments {
  std::string file;
  std::string out;
  double max_gap_s = 5;
};

int RunRebase(const RebaseArguments& arguments) {
  Result<logger::LogReader> reader = OpenWithEvents(arguments.file);
  if (!reader) return Fail(reader.error());
  Result<OutputFile> file = OutputFile::Create(arguments.out);
  if (!file) return Fail(file.error());
  const logger::RebasedLog rebased = logger::RebaseLog(
      *reader, static_cast<std::int64_t>(1e6 * arguments.max_gap_s),
      [&file](std::string_view bytes) {
        file->Write(bytes);
      });
  if (!reader->read_error().empty()) {
    return Fail({ErrorCode::kUnavailable,
                 arguments.file + ": " + reader->read_error()});
  }
  if (const Status written = file->Finish(); !written) {
    return Fail(written.error());
  }
  std::cout << rebased.events << " events, " << rebased.jumps
            << " jumps of time taken out\n";
  return kDone;
}

void AddRebase(CLI::App& log, int& exit_code) {
  CLI::App& command = *log.add_subcommand(
      "rebase",
      "Write a log anew for players, without jumps of its clock: time never "
      "goes back, and on by --max-gap at most from one event to the next. "
      "Without the recorder's seals, which are of the old times");
  const auto arguments = std::make_shared<RebaseArguments>();
  command.add_option("file", arguments->file, "LCM event log")->required();
  command.add_option("--out", arguments->out, "LCM event log to write")
      ->required();
  command
      .add_option("--max-gap", arguments->max_gap_s,
                  "The longest silence that is kept, in seconds")
      ->check(CLI::Range(1e-3, 1e6));
  command.footer(
      "Example:\n  terra log rebase jumped.lcmlog --out even.lcmlog\n"
      "  lcm-logplayer even.lcmlog");
  command.callback([arguments, &exit_code] {
    exit_code = RunRebase(*arguments);
  });
}

}  // namespace

void AddLogCommand(CLI::App& app, int& exit_code) {
  CLI::App& log = *app.add_subcommand("log", "Look into recorded logs");
  log.require_subcommand(1);
  AddInfo(log, exit_code);
  AddAudit(log, exit_code);
  AddReport(log, exit_code);
  AddRebase(log, exit_code);
}

}  // namespace terra::cli
