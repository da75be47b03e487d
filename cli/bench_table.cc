#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "benchmark/detail_tables.h"
#include "benchmark/paper_tables.h"
#include "benchmark/switch_tables.h"
#include "cli/bench_commands.h"
#include "cli/output.h"
#include "output/output_file.h"

namespace terra::cli {
namespace {

using benchmark::LoadedRun;
using benchmark::Table;
using Runs = std::vector<LoadedRun>;

struct TableArguments {
  std::string table;
  std::vector<std::string> runs;
  bool intersect = false;
  bool include_simulated = false;
  std::string format = "markdown";
  std::string out;
};

// A table that can be asked for; `varies`: its runs may differ in stride,
// joints or case list, because it compares just these.
struct NamedTable {
  std::function<Result<Table>(const Runs&)> make;
  bool varies = false;
};

const std::map<std::string, NamedTable>& Tables() {
  static const std::map<std::string, NamedTable> kTables = {
      {"comparison-easy", {[](const Runs& runs) {
         return ComparisonTable(runs, "easy");
       }}},
      {"comparison-hard", {[](const Runs& runs) {
         return ComparisonTable(runs, "hard");
       }}},
      {"proposals-easy", {[](const Runs& runs) {
         return ProposalTable(runs, "easy");
       }}},
      {"proposals-hard", {[](const Runs& runs) {
         return ProposalTable(runs, "hard");
       }}},
      {"paired-easy", {[](const Runs& runs) {
         return PairedTable(runs, "easy");
       }}},
      {"paired-hard", {[](const Runs& runs) {
         return PairedTable(runs, "hard");
       }}},
      {"oracle-gap", {benchmark::OracleGapTable, true}},
      {"joints", {benchmark::JointsTable, true}},
      {"ablation", {benchmark::AblationTable}},
      {"noise", {benchmark::NoiseTable}},
      {"rugd", {benchmark::RugdTable}},
      {"latency", {benchmark::LatencyTable}},
      {"runs", {benchmark::RunsTable, true}},
  };
  return kTables;
}

std::vector<std::string> TableNames() {
  std::vector<std::string> names;
  for (const auto& [name, table] : Tables()) names.push_back(name);
  return names;
}

std::string Format(const Table& table, const std::string& format) {
  if (format == "csv") return ToCsv(table);
  if (format == "latex") return ToLatex(table);
  if (format == "html") return ToHtml(table);
  return ToMarkdown(table);
}

// Refuses rows that cannot stand together.
Status CheckComparable(const Runs& runs, bool intersect) {
  for (std::size_t i = 1; i < runs.size(); ++i) {
    std::string why = WhyNotComparable(runs.front(), runs[i]);
    const bool only_list = why.find("case list") != std::string::npos;
    if (why.empty() || (intersect && only_list)) continue;
    if (only_list) why += "; --intersect takes the cases that all have";
    return Error{ErrorCode::kInvalid, why};
  }
  return Done{};
}

int RunTable(const TableArguments& arguments) {
  Result<Runs> runs = benchmark::LoadRuns(arguments.runs);
  if (!runs.ok()) return Fail(runs.error());
  if (!arguments.include_simulated) {
    std::erase_if(*runs, [](const LoadedRun& run) {
      return run.description.simulated;
    });
  }
  const NamedTable& named = Tables().at(arguments.table);
  if (!named.varies) {
    const Status fit = CheckComparable(*runs, arguments.intersect);
    if (!fit.ok()) return Fail(fit.error());
  }
  const bool intersect = arguments.intersect && !runs->empty();
  if (intersect) {
    const Status kept = benchmark::KeepCommonCases(*runs);
    if (!kept.ok()) return Fail(kept.error());
  }
  Result<Table> table = named.make(*runs);
  if (!table.ok()) return Fail(table.error());
  if (intersect) {
    table->notes.push_back("Only the " +
                           std::to_string(runs->front().num_rows) +
                           " cases that all runs have.");
  }
  const std::string text = Format(*table, arguments.format);
  if (arguments.out.empty()) {
    std::cout << text;
    return kDone;
  }
  const Status written = WriteWholeFile(arguments.out, text);
  return written.ok() ? kDone : Fail(written.error());
}

}  // namespace

void AddBenchTable(CLI::App& bench, int& exit_code) {
  CLI::App& command =
      *bench.add_subcommand("table", "Print one table from runs on disk");
  const auto arguments = std::make_shared<TableArguments>();
  command.add_option("table", arguments->table, "Which one")
      ->required()
      ->check(CLI::IsMember(TableNames()));
  command
      .add_option("--runs", arguments->runs,
                  "Run folders, or a folder above them; the first is the "
                  "reference of paired tables")
      ->required()
      ->type_name("DIR ...");
  command.add_flag("--intersect", arguments->intersect,
                   "Take the cases that all runs have");
  command.add_flag("--include-simulated", arguments->include_simulated,
                   "Take runs against a simulated model, marked SIMULATED");
  command.add_option("--format", arguments->format, "Default markdown")
      ->check(CLI::IsMember({"markdown", "csv", "latex", "html"}));
  command.add_option("--out", arguments->out, "File (default: print it)")
      ->type_name("FILE");
  command.footer(
      "Example:\n"
      "  terra bench table comparison-hard --runs runs/search runs/shortcut");
  command.callback([arguments, &exit_code] {
    exit_code = RunTable(*arguments);
  });
}

}  // namespace terra::cli
