#include "benchmark/measured_columns.h"

#include <utility>

#include "benchmark/run_labels.h"

namespace terra::benchmark {

MeasuredColumn CountColumn(const std::string& name,
                           std::int64_t Metrics::*count) {
  return {{name}, [count](const MeasuredRow& row) {
            return CountCell(row.metrics.*count);
          }};
}

MeasuredColumn PercentColumn(const std::string& name,
                             std::optional<Estimate> Metrics::*estimate) {
  return {{name, true}, [estimate](const MeasuredRow& row) {
            return PercentCell(row.metrics.*estimate);
          }};
}

MeasuredColumn SecondsColumn(const std::string& name,
                             std::optional<double> Metrics::*seconds) {
  return {{name}, [seconds](const MeasuredRow& row) {
            return SecondsCell(row.metrics.*seconds);
          }};
}

MeasuredColumn MethodColumn(const std::string& name,
                            std::set<std::string_view> shown) {
  return {WordColumn(name), [shown = std::move(shown)](const MeasuredRow& row) {
            return TableCell(RowTitle(row.run, shown));
          }};
}

MeasuredColumn GroupColumn(const std::string& name) {
  return {WordColumn(name), [](const MeasuredRow& row) {
            return TableCell(row.group);
          }};
}

MeasuredColumn StrideColumn() {
  return {{"Stride"}, [](const MeasuredRow& row) {
            return CountCell(row.run.description.stride);
          }};
}

MeasuredColumn PathsColumn() {
  return CountColumn("N_Path", &Metrics::paths);
}
MeasuredColumn SuggestedColumn() {
  return CountColumn("N_Suggested", &Metrics::suggested);
}
MeasuredColumn LowerColumn() {
  return CountColumn("N_Lower", &Metrics::lower);
}
MeasuredColumn AsrColumn() {
  return PercentColumn("ASR %", &Metrics::asr);
}
MeasuredColumn IsrColumn() {
  return PercentColumn("ISR %", &Metrics::isr);
}
MeasuredColumn VnsrColumn() {
  return PercentColumn("VNSR %", &Metrics::vnsr);
}
MeasuredColumn FirColumn() {
  return PercentColumn("FIR %", &Metrics::fir);
}
MeasuredColumn AcrColumn() {
  return PercentColumn("ACR_lower %", &Metrics::acr);
}
MeasuredColumn NdrColumn() {
  return PercentColumn("NDR %", &Metrics::ndr);
}
MeasuredColumn ValidityColumn() {
  return PercentColumn("Final validity %", &Metrics::validity);
}
MeasuredColumn ComparableColumn() {
  return CountColumn("N_Comparable", &Metrics::comparable);
}
MeasuredColumn GapRateColumn() {
  return PercentColumn("Gap rate %", &Metrics::gap_rate);
}
MeasuredColumn MeanGapColumn() {
  return PercentColumn("Mean gap %", &Metrics::mean_gap);
}
MeasuredColumn MogrColumn() {
  return PercentColumn("MOGR %", &Metrics::mogr);
}
MeasuredColumn FpsColumn() {
  return {{"FPS"}, [](const MeasuredRow& row) {
            return NumberCell(row.metrics.fps, 2);
          }};
}

std::vector<TableColumn> HeadsOf(const MeasuredColumns& columns) {
  std::vector<TableColumn> heads;
  for (const MeasuredColumn& column : columns) heads.push_back(column.head);
  return heads;
}

void AddRow(const LoadedRun& run, const std::string& group,
            const MeasuredColumns& columns, TableBlock& block) {
  const GroupFigures& figures = FiguresOf(run, group);
  const MeasuredRow row{run, group, figures.metrics, figures.repeats};
  if (row.metrics.paths == 0) return;
  std::vector<TableCell> cells;
  for (const MeasuredColumn& column : columns) {
    cells.push_back(column.cell(row));
  }
  block.rows.push_back(std::move(cells));
}

void AddRows(const LoadedRun& run, const MeasuredColumns& columns,
             TableBlock& block) {
  for (const std::string& group : GroupsOf(run)) {
    AddRow(run, group, columns, block);
  }
}

}  // namespace terra::benchmark
