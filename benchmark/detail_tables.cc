#include "benchmark/detail_tables.h"

#include <algorithm>
#include <utility>

#include "benchmark/comparison.h"
#include "benchmark/measured_columns.h"
#include "benchmark/missing_rows.h"
#include "benchmark/run_fields.h"
#include "benchmark/run_labels.h"

namespace terra::benchmark {
namespace {

// A dataset without a digest of its own has "cases.csv:" before that of its
// table.
std::string ShortDigest(const RunDescription& d) {
  constexpr std::size_t kLength = 12;
  const std::size_t colon = d.dataset_digest.find(':');
  return d.dataset_digest.substr(colon == std::string::npos ? 0 : colon + 1,
                                 kLength);
}

// May its answers have several candidates?
bool HasCandidates(const LoadedRun& run) {
  return SettingOf(run, "candidates") != "1";
}

// Without an interval.
TableCell StrictIsr(const MeasuredRow& row) {
  return PercentCell(row.metrics.strict_isr).text;
}

TableCell NumCandidates(const MeasuredRow& row) {
  return HasCandidates(row.run) ? CountCell(row.metrics.candidates)
                                : TableCell("-");
}

std::vector<TableCell> PairedRow(const LoadedRun& run, const Comparison& c) {
  return {
      RowTitle(run),
      CountCell(c.cases),
      CountCell(c.only_first_lower),
      CountCell(c.only_second_lower),
      c.mcnemar_p < 1e-4 ? TableCell("< 0.0001") : NumberCell(c.mcnemar_p, 4),
      PercentCell(c.mogr_difference)};
}

bool AsksSeveralTimes(const LoadedRun& run) {
  return run.description.repeats > 1;
}

// Of runs that ask once a dash.
MeasuredColumn RepeatsColumn(const std::string& name,
                             double RepeatFigures::*share) {
  return {{name}, [share](const MeasuredRow& row) {
            return AsksSeveralTimes(row.run)
                       ? NumberCell(100 * row.repeats.*share, 2)
                       : TableCell("-");
          }};
}

void AddRepeatsColumns(MeasuredColumns& columns) {
  columns.push_back({{"Repeats"}, [](const MeasuredRow& row) {
                       return CountCell(row.run.description.repeats);
                     }});
  columns.push_back(
      RepeatsColumn("FIR over repeats %", &RepeatFigures::mean_lower));
  columns.push_back(
      RepeatsColumn("Cases that vary %", &RepeatFigures::unstable));
}

}  // namespace

Table ProposalTable(const std::vector<LoadedRun>& runs,
                    const std::string& group) {
  MeasuredColumns columns = {
      MethodColumn(),
      PathsColumn(),
      CountColumn("No baseline", &Metrics::without_baseline),
      CountColumn("N_NoAnswer", &Metrics::no_answer),
      CountColumn("N_Invalid", &Metrics::invalid),
      AsrColumn(),
      IsrColumn(),
      {{"ISR strict %"}, StrictIsr},
      VnsrColumn(),
      GapRateColumn(),
      MeanGapColumn(),
      MogrColumn()};
  if (std::any_of(runs.begin(), runs.end(), HasCandidates)) {
    columns.push_back({{"Candidates"}, NumCandidates});
    columns.push_back(
        PercentColumn("ASR per candidate %", &Metrics::candidate_asr));
    columns.push_back(
        PercentColumn("ISR per candidate %", &Metrics::candidate_isr));
  }
  const bool repeated = std::any_of(runs.begin(), runs.end(), AsksSeveralTimes);
  if (repeated) AddRepeatsColumns(columns);
  Table table;
  table.id = "proposals-" + group;
  table.title = "Proposal quality and recovery, " + group + " subset";
  table.columns = HeadsOf(columns);
  TableBlock block;
  for (const LoadedRun& run : runs) AddRow(run, group, columns, block);
  table.blocks.push_back(std::move(block));
  table.notes = {kIntervalNote,
                 "ISR strict counts answers that were read but not in the "
                 "exact form as invalid. MOGR is for methods with fallback."};
  if (repeated) {
    table.notes.emplace_back(
        "All other columns are of the first repeat. FIR over repeats: mean "
        "over the cases of the share of repeats that were lower. Cases that "
        "vary: lower in some repeats and not in others.");
  }
  return table;
}

Result<Table> PairedTable(const std::vector<LoadedRun>& runs,
                          const std::string& group) {
  Table table;
  table.id = "paired-" + group;
  table.columns = {{"Method"},          {"Cases"},
                   {"Only this lower"}, {"Only the reference lower"},
                   {"McNemar p"},       {"MOGR difference %", true}};
  TableBlock block;
  if (!runs.empty()) {
    const LoadedRun& reference = runs.front();
    table.title =
        "Paired by case against: " + RowTitle(reference) + " (" + group + ")";
    for (std::size_t i = 1; i < runs.size(); ++i) {
      const Result<Comparison> c =
          ComparePaired(ReaderOfGroup(runs[i], group), runs[i].description.rule,
                        ReaderOfGroup(reference, group),
                        reference.description.rule, reference.num_rows);
      if (!c.ok()) return c.error();
      if (c->cases > 0) block.rows.push_back(PairedRow(runs[i], *c));
    }
  }
  table.blocks.push_back(std::move(block));
  table.notes = {
      "McNemar: exact, two-sided, of FIR. MOGR difference: paired "
      "bootstrap over cases; - for methods without fallback."};
  return table;
}

Table JointsTable(const std::vector<LoadedRun>& runs) {
  const MeasuredColumns columns = {
      {{"Joints"},
       [](const MeasuredRow& row) {
         return TableCell(row.run.description.joints);
       }},
      GroupColumn(),
      StrideColumn(),
      ComparableColumn(),
      GapRateColumn(),
      MeanGapColumn()};
  Table table;
  table.id = "joints";
  table.title =
      "Sensitivity to the rule that joins start and goal to the "
      "lattice";
  table.columns = HeadsOf(columns);
  TableBlock block;
  const auto has_row = [](const LoadedRun& run) {
    return run.description.method == "coarse";
  };
  for (const LoadedRun& run : runs) {
    if (has_row(run)) AddRows(run, columns, block);
  }
  table.blocks.push_back(std::move(block));
  table.notes = {
      "2r: nodes within two strides (this project's choice). cell: "
      "the corners of the enclosing lattice cell. visible: every "
      "node that a feasible segment reaches."};
  NoteWithoutRow(runs, has_row, "rows of method coarse alone", table);
  return table;
}

Table RunsTable(const std::vector<LoadedRun>& runs) {
  Table table;
  table.id = "runs";
  table.title = "What produced the rows";
  table.columns = {{"Row"},
                   WordColumn("Folder"),
                   WordColumn("Dataset"),
                   {"Cases"},
                   {"Stride"},
                   WordColumn("Joints"),
                   {"Jobs"},
                   WordColumn("Build"),
                   WordColumn("Started"),
                   WordColumn("Answers recorded"),
                   WordColumn("Command")};
  TableBlock block;
  for (const LoadedRun& run : runs) {
    const RunDescription& d = run.description;
    const std::string recorded = d.recorded.Days();
    block.rows.push_back({RowTitle(run, {kStrideField, kJointsField}),
                          run.folder, DatasetTitle(d) + " " + ShortDigest(d),
                          CountCell(run.num_rows), CountCell(d.stride),
                          d.joints, CountCell(d.jobs), d.build_id,
                          d.started.empty() ? "" : d.started.front(),
                          recorded.empty() ? "-" : recorded, d.command_line});
  }
  table.blocks.push_back(std::move(block));
  if (!runs.empty()) {
    table.notes = {"Machine of the first run: " +
                   runs.front().description.machine};
  }
  return table;
}

}  // namespace terra::benchmark
