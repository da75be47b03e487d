#pragma once

#include <string>
#include <vector>

#include "logger/audit.h"
#include "logger/log_contents.h"
#include "logger/report_stories.h"

namespace terra::logger {

/// The report's tables, as HTML: the newest kMaxRows rows of each.

std::string RequestTable(const std::vector<RequestStory>& stories);
std::string VerdictTable(const LogContents& contents);
/// The last heartbeat of each process, and how long it was silent.
std::string ProcessTable(const LogContents& contents);
std::string AuditTable(const Audit& audit);

}  // namespace terra::logger
