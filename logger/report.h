#pragma once

#include <string>

#include "logger/log_reader.h"

namespace terra::logger {

/// Makes a page about one log: what was asked, advised, decided and deployed
/// when; how the processes were; routes on the map; latencies; the audit.
///
/// The page is one HTML file without scripts or links to anything. Every text
/// that came off the bus is escaped.
/// Bounds: the newest kMaxRows of each table, the newest kMaxMaps maps; charts
///         thin out beyond a few thousand marks.
std::string MakeReport(const std::string& title, LogReader& reader);

}  // namespace terra::logger
