#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "benchmark/loaded_run.h"
#include "benchmark/table.h"

namespace terra::benchmark {

/// What a measured row of a table is of.
struct MeasuredRow {
  const LoadedRun& run;
  const std::string& group;
  const Metrics& metrics;
  const RepeatFigures& repeats;
};

/// A column of measured rows: its head, and how a row's cell comes about.
struct MeasuredColumn {
  TableColumn head;
  std::function<TableCell(const MeasuredRow&)> cell;
};
using MeasuredColumns = std::vector<MeasuredColumn>;

/// Columns of one figure each.
MeasuredColumn CountColumn(const std::string& name,
                           std::int64_t Metrics::*count);
/// In percent, with its interval.
MeasuredColumn PercentColumn(const std::string& name,
                             std::optional<Estimate> Metrics::*estimate);
MeasuredColumn SecondsColumn(const std::string& name,
                             std::optional<double> Metrics::*seconds);

/// What a row is named by: the run, its group, its stride. `shown`: the fields
/// that the table has columns for, which the title leaves out (RowTitle).
MeasuredColumn MethodColumn(const std::string& name = "Method",
                            std::set<std::string_view> shown = {});
MeasuredColumn GroupColumn(const std::string& name = "Subset");
MeasuredColumn StrideColumn();

/// The metrics that several tables have, under one name in all of them.
MeasuredColumn PathsColumn();
MeasuredColumn SuggestedColumn();
MeasuredColumn LowerColumn();
MeasuredColumn AsrColumn();
MeasuredColumn IsrColumn();
MeasuredColumn VnsrColumn();
MeasuredColumn FirColumn();
MeasuredColumn AcrColumn();
MeasuredColumn NdrColumn();
MeasuredColumn ValidityColumn();
MeasuredColumn ComparableColumn();
MeasuredColumn GapRateColumn();
MeasuredColumn MeanGapColumn();
MeasuredColumn MogrColumn();
MeasuredColumn FpsColumn();

/// The heads of columns.
std::vector<TableColumn> HeadsOf(const MeasuredColumns& columns);

/// Adds the row of a group of a run; none where it has no such case.
void AddRow(const LoadedRun& run, const std::string& group,
            const MeasuredColumns& columns, TableBlock& block);
/// A row for each group of a run.
void AddRows(const LoadedRun& run, const MeasuredColumns& columns,
             TableBlock& block);

}  // namespace terra::benchmark
