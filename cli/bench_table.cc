#include <algorithm>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "benchmark/named_tables.h"
#include "cli/bench_commands.h"
#include "cli/output.h"
#include "output/output_file.h"

namespace terra::cli {
namespace {

using benchmark::LoadedRun;
using benchmark::NamedTable;
using benchmark::Shared;
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

std::vector<std::string> TableNames() {
  std::vector<std::string> names;
  for (const NamedTable& table : benchmark::NamedTables()) {
    names.push_back(table.name);
  }
  return names;
}

std::string Format(const Table& table, const std::string& format) {
  if (format == "csv") return ToCsv(table);
  if (format == "latex") return ToLatex(table);
  if (format == "html") return ToHtml(table);
  return ToMarkdown(table);
}

// Refuses rows that cannot stand together.
Status CheckComparable(const Runs& runs, const NamedTable& table,
                       bool intersect) {
  std::set<Shared> varies = table.varies;
  if (intersect) varies.insert(Shared::kCaseList);
  for (std::size_t i = 1; i < runs.size(); ++i) {
    const auto mismatch = FindMismatch(runs.front(), runs[i], varies);
    if (!mismatch.ok()) return mismatch.error();
    if (!mismatch->has_value()) continue;
    std::string why = (*mismatch)->text;
    if ((*mismatch)->what == Shared::kCaseList) {
      why += "; --intersect takes the cases that all have";
    }
    return Error{ErrorCode::kInvalid, why};
  }
  return Done{};
}

// Runs that were named one by one: all of them, or none.
Result<Runs> TakeAll(Runs runs, const NamedTable& table, bool intersect) {
  const Status fit = CheckComparable(runs, table, intersect);
  if (!fit.ok()) return fit.error();
  if (intersect) {
    const Status kept = benchmark::KeepCommonCases(runs);
    if (!kept.ok()) return kept.error();
  }
  if (table.name == "runs") return runs;
  Runs once = benchmark::WithoutDoubles(runs);
  if (once.size() < runs.size()) {
    std::cerr << "note: " << runs.size() - once.size()
              << " runs are left out: each was made in the same way as another "
                 "one of these\n";
  }
  return once;
}

bool Has(const Runs& runs, const LoadedRun& run) {
  return std::any_of(runs.begin(), runs.end(), [&](const LoadedRun& other) {
    return other.description.SameRow(run.description);
  });
}

// Of the runs below a folder those that `report` would take. A run that was
// named itself must be among them.
Result<Runs> TakeAsReport(Runs runs, const TableArguments& arguments,
                          const NamedTable& table) {
  benchmark::SortRows(runs);
  const auto selected = benchmark::SelectRuns(
      runs, arguments.intersect ? benchmark::CaseLists::kCommon
                                : benchmark::CaseLists::kSame);
  if (!selected.ok()) return selected.error();
  Runs rows = (*selected).*table.runs;
  for (const LoadedRun& run : runs) {
    const bool named = std::find(arguments.runs.begin(), arguments.runs.end(),
                                 run.folder) != arguments.runs.end();
    if (named && !Has(rows, run)) {
      return Error{ErrorCode::kInvalid,
                   run.folder + " cannot stand in " + table.name +
                       " beside the runs that are found below the other "
                       "folders; name all runs one by one"};
    }
  }
  std::cerr << "note: " << rows.size() << " of " << runs.size()
            << " runs stand in this table, as in `terra bench report`; name "
               "runs one by one to have just these\n";
  return rows;
}

void DropSimulated(Runs& runs) {
  const std::size_t dropped = std::erase_if(runs, [](const LoadedRun& run) {
    return run.description.simulated;
  });
  if (dropped > 0) {
    std::cerr << "note: " << dropped
              << " runs against a simulated model are left out; "
                 "--include-simulated takes them\n";
  }
}

Result<Runs> RowsOf(const TableArguments& arguments, const NamedTable& table) {
  std::vector<std::string> others;
  Result<Runs> runs = benchmark::LoadRuns(arguments.runs, &others);
  if (!runs.ok()) return runs;
  for (const std::string& other : others) {
    std::cerr << "note: passed over: " << other << "\n";
  }
  if (!arguments.include_simulated) DropSimulated(*runs);
  const bool all_named = std::all_of(
      arguments.runs.begin(), arguments.runs.end(), benchmark::IsRunFolder);
  return all_named ? TakeAll(*std::move(runs), table, arguments.intersect)
                   : TakeAsReport(*std::move(runs), arguments, table);
}

int RunTable(const TableArguments& arguments) {
  const NamedTable& named = benchmark::TableNamed(arguments.table);
  const Result<Runs> runs = RowsOf(arguments, named);
  if (!runs.ok()) return Fail(runs.error());
  if (arguments.intersect && !runs->empty() && runs->front().num_rows == 0) {
    return Fail({ErrorCode::kInvalid, "these runs have no case in common"});
  }
  Result<Table> table = named.make(*runs);
  if (!table.ok()) return Fail(table.error());
  if (arguments.intersect && !runs->empty()) {
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
                  "Run folders: all of them stand in the table, the first is "
                  "the reference of paired ones. Or folders above runs: those "
                  "stand in it that `report` puts there")
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
      "  terra bench table comparison-hard --runs runs/search runs/shortcut\n"
      "  terra bench table oracle-gap --runs runs");
  command.callback([arguments, &exit_code] {
    exit_code = RunTable(*arguments);
  });
}

}  // namespace terra::cli
