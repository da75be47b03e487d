#pragma once

#include <cstdint>
#include <string>

namespace terra::bus {

/// Lines on standard error, with time and the process's name in front.
///
/// Nobody who calls these waits: a thread of the log's own writes the lines.
/// When standard error takes no more (an unread pipe, a stopped terminal, a
/// full disk), the last kMaxQueuedLogLines lines are kept and older ones are
/// dropped and counted. At the end of the process the lines that are left have
/// kLogEndWaitMs to be written; then the process ends without them.
///
/// Threads: any.
void LogInfo(const std::string& text);
void LogWarning(const std::string& text);
void LogError(const std::string& text);

/// Sets the name in front of the lines.
void SetLogName(const std::string& name);

/// Lines that were dropped since the start, because standard error took no more
/// or refused them.
std::int64_t LogLinesDropped();

inline constexpr std::size_t kMaxQueuedLogLines = 1024;
inline constexpr int kLogEndWaitMs = 300;

}  // namespace terra::bus
