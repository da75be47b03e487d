#include "benchmark/switch_tables.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "benchmark/measured_columns.h"
#include "benchmark/missing_rows.h"
#include "benchmark/paper_rows.h"
#include "benchmark/run_fields.h"
#include "benchmark/run_labels.h"
#include "terrain/files/csv.h"

namespace terra::benchmark {
namespace {

// The same words in every row.
MeasuredColumn FixedColumn(const std::string& name, const std::string& text) {
  return {WordColumn(name), [text](const MeasuredRow&) {
            return TableCell(text);
          }};
}

// Which of the switches are on.
struct Switches {
  bool overlay = true;
  bool route_text = true;
  bool rea = true;

  bool operator==(const Switches&) const = default;
};

Switches SwitchesOf(const LoadedRun& run) {
  const auto is_on = [&run](const char* name) {
    return SettingOf(run, name) == "true";
  };
  return {is_on("overlay"), is_on("route_text"), is_on("rea")};
}

// A row of the ablation.
struct AblationSetting {
  std::string name;
  Switches switches;
  std::string options;  ///< Of terra bench run.
  std::string suffix;   ///< Of the folder.
  bool of_paper = true;
};

// "without A, B"
std::string NameOf(const Switches& switches) {
  std::string text;
  for (const auto& [is_on, name] :
       {std::pair(switches.overlay, "overlay"),
        std::pair(switches.route_text, "route text"),
        std::pair(switches.rea, "REA")}) {
    if (!is_on) text += (text.empty() ? "without " : ", ") + std::string(name);
  }
  return text;
}

// The paper's settings, then what else the runs have.
std::vector<AblationSetting> SettingsOfAblation(
    const std::vector<LoadedRun>& runs) {
  std::vector<AblationSetting> settings = {
      {"full advisor", {}, "", ""},
      {"without overlay and route text",
       {false, false, true},
       " --no-overlay --no-route-text",
       "-no-baseline"},
      {"without route text",
       {true, false, true},
       " --no-route-text",
       "-no-route-text"},
      {"without REA", {true, true, false}, " --no-rea", "-no-rea"}};
  for (const LoadedRun& run : runs) {
    const Switches switches = SwitchesOf(run);
    const bool known = std::any_of(settings.begin(), settings.end(),
                                   [&](const AblationSetting& setting) {
                                     return setting.switches == switches;
                                   });
    if (!known) settings.push_back({NameOf(switches), switches, "", "", false});
  }
  return settings;
}

// The percentages of the paper and of the runs, in order.
std::set<double> NoiseLevels(const std::vector<LoadedRun>& runs) {
  std::set<double> levels = {0, 5, 10};
  for (const LoadedRun& run : runs) {
    levels.insert(std::stod(SettingOf(run, "noise")));
  }
  return levels;
}

std::vector<LoadedRun> Those(const std::vector<LoadedRun>& runs,
                             const std::function<bool(const LoadedRun&)>& of) {
  std::vector<LoadedRun> those;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(those), of);
  return those;
}

constexpr const char* kOnlyPaperSettings =
    "only runs of advisor with a model whose other settings are the paper's";

}  // namespace

Table AblationTable(const std::vector<LoadedRun>& runs) {
  // The first column is each setting's own.
  MeasuredColumns columns = {
      FixedColumn("Setting", ""),
      GroupColumn(),
      MethodColumn("Model", {kOverlayField, kRouteTextField, kReaField}),
      SuggestedColumn(),
      AsrColumn(),
      FirColumn(),
      AcrColumn(),
      IsrColumn(),
      VnsrColumn()};
  Table table;
  table.id = "ablation";
  table.title = "Ablation of what the advisor is shown";
  table.columns = HeadsOf(columns);
  TableBlock measured;
  measured.heading = "Measured here";
  TableBlock missing;
  missing.heading = kMissingHeading;
  const std::vector<LoadedRun> all = Those(runs, IsOfAblation);
  for (const AblationSetting& setting : SettingsOfAblation(all)) {
    columns.front() = FixedColumn("Setting", setting.name);
    const std::vector<LoadedRun> rows = Those(all, [&](const LoadedRun& run) {
      return SwitchesOf(run) == setting.switches;
    });
    for (const LoadedRun& run : rows) AddRows(run, columns, measured);
    if (setting.of_paper && !IsMeasured(rows, "advisor", "openai", kSubsets)) {
      missing.rows.push_back(
          {setting.name,
           HowToMeasure("advisor", "openai", setting.options, setting.suffix)});
    }
  }
  if (!measured.rows.empty()) table.blocks.push_back(std::move(measured));
  if (!missing.rows.empty()) table.blocks.push_back(std::move(missing));
  table.blocks.push_back(PaperBlock(table.id, table.columns));
  table.notes = {kIntervalNote,
                 "Full advisor: overlay, route text and reference pair (REA)."};
  NoteWithoutRow(runs, IsOfAblation, kOnlyPaperSettings, table);
  return table;
}

Table NoiseTable(const std::vector<LoadedRun>& runs) {
  const MeasuredColumns columns = {
      MethodColumn("Method", {kNoiseField}),
      GroupColumn(),
      {{"Noise %"},
       [](const MeasuredRow& row) {
         return TableCell(SettingOf(row.run, "noise"));
       }},
      PathsColumn(),
      SuggestedColumn(),
      LowerColumn(),
      AsrColumn(),
      IsrColumn(),
      VnsrColumn(),
      FirColumn(),
      AcrColumn(),
      NdrColumn()};
  Table table;
  table.id = "noise";
  table.title = "Noise on the map that the model is shown";
  table.columns = HeadsOf(columns);
  TableBlock measured;
  measured.heading = "Measured here";
  TableBlock missing;
  missing.heading = kMissingHeading;
  const std::vector<LoadedRun> all = Those(runs, IsOfNoise);
  for (const double level : NoiseLevels(all)) {
    const std::string noise = FormatNumber(level);
    const std::vector<LoadedRun> rows = Those(all, [&](const LoadedRun& run) {
      return SettingOf(run, "noise") == noise;
    });
    for (const LoadedRun& run : rows) AddRows(run, columns, measured);
    const bool of_paper = level == 0 || level == 5 || level == 10;
    if (of_paper && !IsMeasured(rows, "advisor", "openai", kSubsets)) {
      missing.rows.push_back(
          {"LLM-Advisor (gpt-5.5), noise " + noise + " %",
           HowToMeasure("advisor", "openai", " --cases 50 --noise " + noise,
                        "-noise" + noise)});
    }
  }
  if (!measured.rows.empty()) table.blocks.push_back(std::move(measured));
  if (!missing.rows.empty()) table.blocks.push_back(std::move(missing));
  table.blocks.push_back(PaperBlock(table.id, table.columns));
  table.notes = {
      "The first 50 cases of each subset. Baseline, its description "
      "and all checks use the clean map."};
  NoteWithoutRow(runs, IsOfNoise, kOnlyPaperSettings, table);
  return table;
}

}  // namespace terra::benchmark
