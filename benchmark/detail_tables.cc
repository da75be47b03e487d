#include "benchmark/detail_tables.h"

#include <algorithm>
#include <utility>

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
  return SettingOf(run, "candidates", "1") != "1";
}

}  // namespace

Table ProposalTable(const std::vector<LoadedRun>& runs,
                    const std::string& group) {
  Table table;
  table.id = "proposals-" + group;
  table.title = "Proposal quality and recovery, " + group + " subset";
  table.columns = {
      {"Method"},           {"N_Path"},           {"No baseline"},
      {"N_NoAnswer"},       {"N_Invalid"},        {"ASR %", true},
      {"ISR %", true},      {"ISR strict %"},     {"VNSR %", true},
      {"Gap rate %", true}, {"Mean gap %", true}, {"MOGR %", true}};
  const bool several = std::any_of(runs.begin(), runs.end(), HasCandidates);
  if (several) {
    table.columns.push_back({"Candidates"});
    table.columns.push_back({"ASR per candidate %", true});
    table.columns.push_back({"ISR per candidate %", true});
  }
  TableBlock block;
  for (const LoadedRun& run : runs) {
    const Metrics m = MetricsOf(run, group);
    if (m.paths == 0) continue;
    TableCell strict = PercentCell(m.strict_isr);
    strict.low.clear();
    block.rows.push_back({RowTitle(run), CountCell(m.paths),
                          CountCell(m.without_baseline), CountCell(m.no_answer),
                          CountCell(m.invalid), PercentCell(m.asr),
                          PercentCell(m.isr), strict, PercentCell(m.vnsr),
                          PercentCell(m.gap_rate), PercentCell(m.mean_gap),
                          PercentCell(m.mogr)});
    if (!several) continue;
    auto& row = block.rows.back();
    row.emplace_back(HasCandidates(run) ? CountCell(m.candidates) : "-");
    row.push_back(PercentCell(m.candidate_asr));
    row.push_back(PercentCell(m.candidate_isr));
  }
  table.blocks.push_back(std::move(block));
  table.notes = {kIntervalNote,
                 "ISR strict counts answers that were read but not in the "
                 "exact form as invalid. MOGR is for methods with fallback."};
  return table;
}

Table PairedTable(const std::vector<LoadedRun>& runs,
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
    const std::vector<Score> others = ScoresOfGroup(reference, group);
    for (std::size_t i = 1; i < runs.size(); ++i) {
      const Comparison c =
          ComparePaired(ScoresOfGroup(runs[i], group), runs[i].description.rule,
                        others, reference.description.rule);
      if (c.cases == 0) continue;
      block.rows.push_back({RowTitle(runs[i]), CountCell(c.cases),
                            CountCell(c.only_first_lower),
                            CountCell(c.only_second_lower),
                            c.mcnemar_p < 1e-4 ? TableCell("< 0.0001")
                                               : NumberCell(c.mcnemar_p, 4),
                            PercentCell(c.mogr_difference)});
    }
  }
  table.blocks.push_back(std::move(block));
  table.notes = {
      "McNemar: exact, two-sided, of FIR. MOGR difference: paired "
      "bootstrap over cases; - for methods without fallback."};
  return table;
}

Table JointsTable(const std::vector<LoadedRun>& runs) {
  Table table;
  table.id = "joints";
  table.title =
      "Sensitivity to the rule that joins start and goal to the "
      "lattice";
  table.columns = {{"Joints"},           WordColumn("Subset"),
                   {"Stride"},           {"N_Comparable"},
                   {"Gap rate %", true}, {"Mean gap %", true}};
  TableBlock block;
  for (const LoadedRun& run : runs) {
    if (run.description.method != "coarse") continue;
    for (const std::string& group : GroupsOf(run)) {
      const Metrics m = MetricsOf(run, group);
      block.rows.push_back({run.description.joints, group,
                            CountCell(run.description.stride),
                            CountCell(m.comparable), PercentCell(m.gap_rate),
                            PercentCell(m.mean_gap)});
    }
  }
  table.blocks.push_back(std::move(block));
  table.notes = {
      "2r: nodes within two strides (this project's choice). cell: "
      "the corners of the enclosing lattice cell. visible: every "
      "node that a feasible segment reaches."};
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
    block.rows.push_back(
        {RowTitle(run), run.folder, DatasetTitle(d) + " " + ShortDigest(d),
         CountCell(static_cast<std::int64_t>(run.scores.size())),
         CountCell(d.stride), d.joints, CountCell(d.jobs), d.build_id,
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
