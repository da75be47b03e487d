#pragma once

#include <iosfwd>

#include "logger/log_info.h"

namespace terra::cli {

/// Prints what a log holds: a table for people, or JSON.
void PrintLogInfo(const logger::LogInfo& info, std::ostream& out);
void PrintLogInfoJson(const logger::LogInfo& info, std::ostream& out);

}  // namespace terra::cli
