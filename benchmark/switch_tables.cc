#include "benchmark/switch_tables.h"

#include <utility>

#include "benchmark/measured_columns.h"
#include "benchmark/missing_rows.h"
#include "benchmark/paper_rows.h"
#include "benchmark/run_labels.h"

namespace terra::benchmark {
namespace {

// The same words in every row.
MeasuredColumn FixedColumn(const std::string& name, const std::string& text) {
  return {WordColumn(name), [text](const MeasuredRow&) {
            return TableCell(text);
          }};
}

}  // namespace

Table AblationTable(const std::vector<LoadedRun>& runs) {
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
  // The first column is each setting's own.
  MeasuredColumns columns = {FixedColumn("Setting", ""),
                             GroupColumn(),
                             MethodColumn("Model"),
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
  missing.heading = "Not measured here";
  for (const Setting& setting : kSettings) {
    columns.front() = FixedColumn("Setting", setting.name);
    bool found = false;
    for (const LoadedRun& run : runs) {
      if (!IsAdvisedByModel(run) || SettingOf(run, "noise", "0") != "0" ||
          SettingOf(run, "overlay", "true") != setting.overlay ||
          SettingOf(run, "route_text", "true") != setting.route_text ||
          SettingOf(run, "rea", "true") != setting.rea) {
        continue;
      }
      found = found || !run.description.simulated;
      AddRows(run, columns, measured);
    }
    if (!found) {
      missing.rows.push_back(
          {setting.name, HowToMeasure("advisor", "openai", setting.switches,
                                      setting.suffix)});
    }
  }
  if (!measured.rows.empty()) table.blocks.push_back(std::move(measured));
  if (!missing.rows.empty()) table.blocks.push_back(std::move(missing));
  table.blocks.push_back(PaperBlock(table.id, table.columns));
  table.notes = {kIntervalNote,
                 "Full advisor: overlay, route text and reference pair (REA)."};
  return table;
}

Table NoiseTable(const std::vector<LoadedRun>& runs) {
  const MeasuredColumns columns = {
      MethodColumn(),
      GroupColumn(),
      {{"Noise %"},
       [](const MeasuredRow& row) {
         return TableCell(SettingOf(row.run, "noise", "0"));
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
  missing.heading = "Not measured here";
  for (const char* noise : {"0", "5", "10"}) {
    bool found = false;
    for (const LoadedRun& run : runs) {
      if (!IsAdvisedByModel(run) || SettingOf(run, "noise", "0") != noise) {
        continue;
      }
      found = found || !run.description.simulated;
      AddRows(run, columns, measured);
    }
    if (!found) {
      missing.rows.push_back(
          {std::string("LLM-Advisor (gpt-5.5), noise ") + noise + " %",
           HowToMeasure("advisor", "openai",
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
