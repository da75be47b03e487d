#include "benchmark/paper_tables.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "benchmark/measured_columns.h"
#include "benchmark/missing_rows.h"
#include "benchmark/paper_rows.h"
#include "benchmark/run_fields.h"
#include "benchmark/run_labels.h"

namespace terra::benchmark {
namespace {

constexpr const char* kNotTheirMaps =
    "These are not the paper's maps: generated after its description and "
    "calibrated to its gap table.";

// "0" without a model. Rounds end at a Yes, an accepted route or the deadline.
std::string CallsPerCase(const LoadedRun& run) {
  if (!run.description.asks_model) return "0";
  const std::string rounds = SettingOf(run, "rounds");
  return rounds == "1" ? "1" : "1 to " + rounds;
}

constexpr int kPaperStrides[] = {10, 20, 50, 100};

// The paper's rows with a model, by subset and stride, that no run stands for.
void AddMissingGaps(const std::vector<LoadedRun>& runs, Table& table) {
  TableBlock missing;
  missing.heading = kMissingHeading;
  for (const std::string& group : kSubsets) {
    for (const int stride : kPaperStrides) {
      std::vector<LoadedRun> at_stride;
      for (const LoadedRun& run : runs) {
        if (IsOfGap(run) && run.description.stride == stride) {
          at_stride.push_back(run);
        }
      }
      if (IsMeasured(at_stride, "advisor", "openai", {group})) continue;
      const std::string number = std::to_string(stride);
      missing.rows.push_back(
          {group, CountCell(stride), "LLM-Advisor (gpt-5.5)",
           HowToMeasure("advisor", "openai", " --stride " + number,
                        "-stride-" + number)});
    }
  }
  if (!missing.rows.empty()) table.blocks.push_back(std::move(missing));
}

// Runs whose times are of one case at a time.
std::vector<LoadedRun> OneAtATime(const std::vector<LoadedRun>& runs) {
  std::vector<LoadedRun> alone;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(alone),
               [](const LoadedRun& run) {
                 return run.description.jobs == 1;
               });
  return alone;
}

}  // namespace

Table ComparisonTable(const std::vector<LoadedRun>& runs,
                      const std::string& group) {
  const MeasuredColumns columns = {
      MethodColumn(),
      LowerColumn(),
      {{"N_NonImproving"},
       [](const MeasuredRow& row) {
         return CountCell(row.metrics.non_improving());
       }},
      SuggestedColumn(),
      FirColumn(),
      NdrColumn(),
      ValidityColumn(),
      AcrColumn(),
      FpsColumn()};
  Table table;
  table.id = "comparison-" + group;
  table.title = "Main comparison, " + group + " subset of " +
                (runs.empty() ? "" : DatasetTitle(runs.front().description)) +
                ", against the coarse-lattice baseline";
  table.columns = HeadsOf(columns);
  TableBlock measured;
  measured.heading = "Measured here";
  for (const LoadedRun& run : runs) AddRow(run, group, columns, measured);
  table.blocks.push_back(std::move(measured));
  AddMissing(runs, {group}, table);
  table.blocks.push_back(PaperBlock(table.id, table.columns));
  table.notes = {kIntervalNote, kNotTheirMaps,
                 "FPS = cases over the sum of their end-to-end times; from "
                 "runs with several jobs it is a lower bound."};
  return table;
}

Table OracleGapTable(const std::vector<LoadedRun>& runs) {
  const MeasuredColumns columns = {GroupColumn(),
                                   StrideColumn(),
                                   MethodColumn("Method", {kStrideField}),
                                   ComparableColumn(),
                                   CountColumn("N_Gap", &Metrics::gaps),
                                   GapRateColumn(),
                                   MeanGapColumn(),
                                   MogrColumn()};
  Table table;
  table.id = "oracle-gap";
  table.title =
      "Gap of the coarse lattice to the native optimum, and how much "
      "of it is recovered, by stride";
  table.columns = HeadsOf(columns);
  std::vector<const LoadedRun*> by_stride;
  for (const LoadedRun& run : runs) {
    if (IsOfGap(run)) by_stride.push_back(&run);
  }
  std::stable_sort(by_stride.begin(), by_stride.end(),
                   [](const LoadedRun* a, const LoadedRun* b) {
                     return a->description.stride < b->description.stride;
                   });
  TableBlock block;
  block.heading = "Measured here";
  for (const std::string& group : GroupsOfAll(runs)) {
    for (const LoadedRun* run : by_stride) {
      AddRow(*run, group, columns, block);
    }
  }
  table.blocks.push_back(std::move(block));
  AddMissingGaps(runs, table);
  TableBlock paper;
  paper.heading = kPaperHeading;
  paper.published = true;
  for (const Subset subset : {Subset::kEasy, Subset::kHard}) {
    for (const int stride : kPaperStrides) {
      const PaperGap row = PaperGapOf(subset, stride);
      const auto n = static_cast<std::int64_t>(row.gap_rate * 10 + 0.5);
      paper.rows.push_back({std::string(SubsetName(subset)), CountCell(stride),
                            "LLM-Advisor (GPT-5.5)", CountCell(1000),
                            CountCell(n), NumberCell(row.gap_rate, 2),
                            NumberCell(row.mean_gap, 2),
                            NumberCell(row.mogr, 2)});
    }
  }
  table.blocks.push_back(std::move(paper));
  table.notes = {kIntervalNote, kNotTheirMaps};
  NoteWithoutRow(runs, IsOfGap,
                 "no runs with noise or an ablation, and none without fallback",
                 table);
  return table;
}

Table RugdTable(const std::vector<LoadedRun>& runs) {
  const MeasuredColumns columns = {
      MethodColumn(), GroupColumn("Scene"), PathsColumn(), SuggestedColumn(),
      LowerColumn(),  AsrColumn(),          FirColumn(),   AcrColumn(),
      IsrColumn(),    VnsrColumn(),         NdrColumn(),   ValidityColumn(),
      FpsColumn()};
  Table table;
  table.id = "rugd";
  table.title = "RUGD semantic-cost transfer, by scene";
  table.columns = HeadsOf(columns);
  TableBlock measured;
  measured.heading = "Measured here";
  for (const LoadedRun& run : runs) {
    for (const std::string& scene : kScenes) {
      AddRow(run, scene, columns, measured);
    }
  }
  if (measured.rows.empty()) {
    measured.rows.push_back(
        {"all methods",
         "not measured; terra bench rugd --annotations DIR --out rugd, then "
         "terra bench run --dataset rugd --method advisor --backend shortcut "
         "--out runs/rugd-shortcut"});
  }
  table.blocks.push_back(std::move(measured));
  AddMissing(runs, kScenes, table, "", "-rugd");
  table.blocks.push_back(PaperBlock(table.id, table.columns));
  table.notes = {
      "Intervals of means: bootstrap over sequences, not frames.",
      "Frames in the paper (used of all): creek 745 of 836, park 1,638 of "
      "1,640, trail 3,875 of 4,843, village 117 of 117.",
      "Derived from RUGD (Wigness et al., IROS 2019), which states no licence: "
      "do not redistribute."};
  return table;
}

Table LatencyTable(const std::vector<LoadedRun>& runs) {
  const MeasuredColumns columns = {
      MethodColumn(),
      GroupColumn(),
      PathsColumn(),
      {{"Online LLM calls / case"},
       [](const MeasuredRow& row) {
         return TableCell(CallsPerCase(row.run));
       }},
      SecondsColumn("T_prep s", &Metrics::prep_median),
      {{"T_llm s"},
       [](const MeasuredRow& row) {
         return row.run.description.asks_model
                    ? SecondsCell(row.metrics.llm_median)
                    : TableCell("-");
       }},
      SecondsColumn("T_det s", &Metrics::det_median),
      SecondsColumn("Median T_e2e s", &Metrics::e2e_median),
      SecondsColumn("p95 s", &Metrics::e2e_p95)};
  Table table;
  table.id = "latency";
  table.title = "Online latency, one case at a time";
  table.columns = HeadsOf(columns);
  TableBlock measured;
  measured.heading = "Measured here";
  for (const LoadedRun& run : OneAtATime(runs)) {
    AddRows(run, columns, measured);
  }
  if (!measured.rows.empty()) table.blocks.push_back(std::move(measured));
  AddMissing(OneAtATime(runs), kSubsets, table, " --cases 50", "-latency");
  table.blocks.push_back(PaperBlock(table.id, table.columns));
  table.notes = {
      "Medians of each stage, p95 by nearest rank; only runs with --jobs 1.",
      "T_prep: map decoding, pictures, text, encoding. T_det: baseline "
      "planning where the method has one, parsing, native legs, verification "
      "and comparison. Other machine than the paper's."};
  return table;
}

}  // namespace terra::benchmark
