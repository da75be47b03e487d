#include "benchmark/paper_tables.h"

#include <algorithm>
#include <utility>

#include "benchmark/paper_rows.h"
#include "benchmark/run_labels.h"

namespace terra::benchmark {
namespace {

// A row of the paper that a run here may stand for.
struct PaperRow {
  const char* method;
  const char* backend;
  const char* title;
};

constexpr PaperRow kPaperMethods[] = {
    {"direct", "openai", "Direct LLM (gpt-5.5)"},
    {"direct", "gemini", "Direct LLM (gemini-3.1-pro-preview)"},
    {"direct", "anthropic", "Direct LLM (claude-opus-4-8)"},
    {"llm-astar", "openai", "LLM-A* (gpt-5.5)"},
    {"advisor", "openai", "LLM-Advisor (gpt-5.5)"},
    {"advisor", "gemini", "LLM-Advisor (gemini-3.1-pro-preview)"},
    {"advisor", "anthropic", "LLM-Advisor (claude-opus-4-8)"},
};

std::string KeyVariable(const std::string& backend) {
  if (backend == "openai") return "OPENAI_API_KEY";
  if (backend == "gemini") return "GEMINI_API_KEY";
  return "ANTHROPIC_API_KEY";
}

// What would measure a row: `more` options, into a folder with this suffix.
std::string Command(const std::string& method, const std::string& backend,
                    const std::string& more = "",
                    const std::string& suffix = "") {
  return "not measured; " + KeyVariable(backend) +
         "=... terra bench run --dataset DIR --method " + method +
         " --backend " + backend + more + " --out runs/" + method + "-" +
         backend + suffix;
}

bool Measured(const std::vector<LoadedRun>& runs, const std::string& method,
              const std::string& backend) {
  return std::any_of(runs.begin(), runs.end(), [&](const LoadedRun& run) {
    return run.description.method == method && ProviderOf(run) == backend &&
           !run.description.simulated;
  });
}

constexpr const char* kNotTheirMaps =
    "These are not the paper's maps: generated after its description and "
    "calibrated to its gap table.";

// Rounds end at a Yes, an accepted route or the deadline.
std::string CallsPerCase(const LoadedRun& run) {
  const std::string rounds = SettingOf(run, "rounds", "1");
  return rounds == "1" ? "1" : "1 to " + rounds;
}

void AddMissing(const std::vector<LoadedRun>& runs, Table& table,
                const std::string& more = "", const std::string& suffix = "") {
  TableBlock missing;
  missing.heading = "Not measured here";
  for (const PaperRow& row : kPaperMethods) {
    if (Measured(runs, row.method, row.backend)) continue;
    missing.rows.push_back(
        {row.title, Command(row.method, row.backend, more, suffix)});
  }
  if (!missing.rows.empty()) table.blocks.push_back(std::move(missing));
}

}  // namespace

Table ComparisonTable(const std::vector<LoadedRun>& runs,
                      const std::string& group) {
  Table table;
  table.id = "comparison-" + group;
  table.title = "Main comparison, " + group + " subset of " +
                (runs.empty() ? "" : DatasetTitle(runs.front().description)) +
                ", against the coarse-lattice baseline";
  table.columns = {{"Method"},
                   {"N_Lower"},
                   {"N_NonImproving"},
                   {"N_Suggested"},
                   {"FIR %", true},
                   {"NDR %", true},
                   {"Final validity %", true},
                   {"ACR_lower %", true},
                   {"FPS"}};
  TableBlock measured;
  measured.heading = "Measured here";
  for (const LoadedRun& run : runs) {
    const Metrics m = MetricsOf(run, group);
    if (m.paths == 0) continue;
    measured.rows.push_back(
        {RowTitle(run), CountCell(m.lower), CountCell(m.non_improving()),
         CountCell(m.suggested), PercentCell(m.fir), PercentCell(m.ndr),
         PercentCell(m.validity), PercentCell(m.acr), NumberCell(m.fps, 2)});
  }
  table.blocks.push_back(std::move(measured));
  AddMissing(runs, table);
  table.blocks.push_back(PaperBlock(table.id, table.columns));
  table.notes = {kIntervalNote, kNotTheirMaps,
                 "FPS = cases over the sum of their end-to-end times; from "
                 "runs with several jobs it is a lower bound."};
  return table;
}

Table OracleGapTable(const std::vector<LoadedRun>& runs) {
  Table table;
  table.id = "oracle-gap";
  table.title =
      "Gap of the coarse lattice to the native optimum, and how much "
      "of it is recovered, by stride";
  table.columns = {{"Subset"},           {"Stride"},      WordColumn("Method"),
                   {"N_Comparable"},     {"N_Gap"},       {"Gap rate %", true},
                   {"Mean gap %", true}, {"MOGR %", true}};
  std::vector<const LoadedRun*> by_stride;
  for (const LoadedRun& run : runs) {
    if (run.description.rule.fallback) by_stride.push_back(&run);
  }
  std::stable_sort(by_stride.begin(), by_stride.end(),
                   [](const LoadedRun* a, const LoadedRun* b) {
                     return a->description.stride < b->description.stride;
                   });
  TableBlock block;
  block.heading = "Measured here";
  for (const std::string& group : GroupsOfAll(runs)) {
    for (const LoadedRun* run : by_stride) {
      const Metrics m = MetricsOf(*run, group);
      if (m.paths == 0) continue;
      block.rows.push_back({group, CountCell(run->description.stride),
                            RowTitle(*run), CountCell(m.comparable),
                            CountCell(m.gaps), PercentCell(m.gap_rate),
                            PercentCell(m.mean_gap), PercentCell(m.mogr)});
    }
  }
  table.blocks.push_back(std::move(block));
  TableBlock paper;
  paper.heading = kPaperHeading;
  paper.published = true;
  for (const Subset subset : {Subset::kEasy, Subset::kHard}) {
    for (const int stride : {10, 20, 50, 100}) {
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
  return table;
}

Table AblationTable(const std::vector<LoadedRun>& runs) {
  Table table;
  table.id = "ablation";
  table.title = "Ablation of what the advisor is shown";
  table.columns = {
      {"Setting"},           WordColumn("Subset"), WordColumn("Model"),
      {"N_Suggested"},       {"ASR %", true},      {"FIR %", true},
      {"ACR_lower %", true}, {"ISR %", true},      {"VNSR %", true}};
  struct Setting {
    const char* name;
    const char* overlay;
    const char* route_text;
    const char* rea;
    const char* switches;
    const char* suffix;
  };
  constexpr Setting kSettings[] = {
      {"full advisor", "true", "true", "true", "", ""},
      {"without overlay and route text", "false", "false", "true",
       " --no-overlay --no-route-text", "-no-baseline"},
      {"without route text", "true", "false", "true", " --no-route-text",
       "-no-route-text"},
      {"without REA", "true", "true", "false", " --no-rea", "-no-rea"}};
  TableBlock measured;
  measured.heading = "Measured here";
  TableBlock missing;
  missing.heading = "Not measured here";
  for (const Setting& setting : kSettings) {
    bool found = false;
    for (const LoadedRun& run : runs) {
      if (run.description.method != "advisor" || !run.description.asks_model ||
          SettingOf(run, "noise", "0") != "0" ||
          SettingOf(run, "overlay", "true") != setting.overlay ||
          SettingOf(run, "route_text", "true") != setting.route_text ||
          SettingOf(run, "rea", "true") != setting.rea) {
        continue;
      }
      found = found || !run.description.simulated;
      for (const std::string& group : GroupsOf(run)) {
        const Metrics m = MetricsOf(run, group);
        measured.rows.push_back({setting.name, group, RowTitle(run),
                                 CountCell(m.suggested), PercentCell(m.asr),
                                 PercentCell(m.fir), PercentCell(m.acr),
                                 PercentCell(m.isr), PercentCell(m.vnsr)});
      }
    }
    if (!found) {
      missing.rows.push_back(
          {setting.name,
           Command("advisor", "openai", setting.switches, setting.suffix)});
    }
  }
  if (!measured.rows.empty()) table.blocks.push_back(std::move(measured));
  if (!missing.rows.empty()) table.blocks.push_back(std::move(missing));
  table.blocks.push_back(PaperBlock(table.id, table.columns));
  table.notes = {kIntervalNote,
                 "Full advisor: overlay, route text and reference pair (REA)."};
  return table;
}

Table RugdTable(const std::vector<LoadedRun>& runs) {
  Table table;
  table.id = "rugd";
  table.title = "RUGD semantic-cost transfer, by scene";
  table.columns = {
      {"Method"},       WordColumn("Scene"),   {"N_Path"},
      {"N_Suggested"},  {"N_Lower"},           {"ASR %", true},
      {"FIR %", true},  {"ACR_lower %", true}, {"ISR %", true},
      {"VNSR %", true}, {"NDR %", true},       {"Final validity %", true},
      {"FPS"}};
  TableBlock measured;
  measured.heading = "Measured here";
  for (const LoadedRun& run : runs) {
    for (const char* scene : {"creek", "park", "trail", "village"}) {
      const Metrics m = MetricsOf(run, scene);
      if (m.paths == 0) continue;
      measured.rows.push_back(
          {RowTitle(run), scene, CountCell(m.paths), CountCell(m.suggested),
           CountCell(m.lower), PercentCell(m.asr), PercentCell(m.fir),
           PercentCell(m.acr), PercentCell(m.isr), PercentCell(m.vnsr),
           PercentCell(m.ndr), PercentCell(m.validity), NumberCell(m.fps, 2)});
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
  AddMissing(runs, table, "", "-rugd");
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
  Table table;
  table.id = "latency";
  table.title = "Online latency, one case at a time";
  table.columns = {{"Method"},   WordColumn("Subset"),
                   {"N_Path"},   {"Online LLM calls / case"},
                   {"T_prep s"}, {"T_llm s"},
                   {"T_det s"},  {"Median T_e2e s"},
                   {"p95 s"}};
  TableBlock measured;
  measured.heading = "Measured here";
  for (const LoadedRun& run : runs) {
    if (run.description.jobs != 1) continue;
    for (const std::string& group : GroupsOf(run)) {
      const Metrics m = MetricsOf(run, group);
      if (m.paths == 0) continue;
      const bool model = run.description.asks_model;
      const std::string calls = model ? CallsPerCase(run) : "0";
      measured.rows.push_back(
          {RowTitle(run), group, CountCell(m.paths), calls,
           SecondsCell(m.prep_median), model ? SecondsCell(m.llm_median) : "-",
           SecondsCell(m.det_median), SecondsCell(m.e2e_median),
           SecondsCell(m.e2e_p95)});
    }
  }
  if (!measured.rows.empty()) table.blocks.push_back(std::move(measured));
  AddMissing(runs, table, " --cases 50", "-latency");
  table.blocks.push_back(PaperBlock(table.id, table.columns));
  table.notes = {
      "Medians of each stage, p95 by nearest rank; only runs with --jobs 1.",
      "T_prep: map decoding, pictures, text, encoding. T_det: baseline "
      "planning where the method has one, parsing, native legs, verification "
      "and comparison. Other machine than the paper's."};
  return table;
}

Table NoiseTable(const std::vector<LoadedRun>& runs) {
  Table table;
  table.id = "noise";
  table.title = "Noise on the map that the model is shown";
  table.columns = {{"Method"},      WordColumn("Subset"),  {"Noise %"},
                   {"N_Path"},      {"N_Suggested"},       {"N_Lower"},
                   {"ASR %", true}, {"ISR %", true},       {"VNSR %", true},
                   {"FIR %", true}, {"ACR_lower %", true}, {"NDR %", true}};
  TableBlock measured;
  measured.heading = "Measured here";
  TableBlock missing;
  missing.heading = "Not measured here";
  for (const char* noise : {"0", "5", "10"}) {
    bool found = false;
    for (const LoadedRun& run : runs) {
      if (!run.description.asks_model || run.description.method != "advisor" ||
          SettingOf(run, "noise", "0") != noise) {
        continue;
      }
      found = found || !run.description.simulated;
      for (const std::string& group : GroupsOf(run)) {
        const Metrics m = MetricsOf(run, group);
        measured.rows.push_back(
            {RowTitle(run), group, noise, CountCell(m.paths),
             CountCell(m.suggested), CountCell(m.lower), PercentCell(m.asr),
             PercentCell(m.isr), PercentCell(m.vnsr), PercentCell(m.fir),
             PercentCell(m.acr), PercentCell(m.ndr)});
      }
    }
    if (!found) {
      missing.rows.push_back(
          {std::string("LLM-Advisor (gpt-5.5), noise ") + noise + " %",
           Command("advisor", "openai",
                   std::string(" --cases 50 --noise ") + noise,
                   std::string("-noise") + noise)});
    }
  }
  if (!measured.rows.empty()) table.blocks.push_back(std::move(measured));
  if (!missing.rows.empty()) table.blocks.push_back(std::move(missing));
  table.blocks.push_back(PaperBlock(table.id, table.columns));
  table.notes = {
      "The first 50 cases of each subset. Baseline, its description "
      "and all checks use the clean map."};
  return table;
}

}  // namespace terra::benchmark
