#pragma once

#include <string>

namespace terra::bus {

/// Lines on standard error, with time and the process's name in front.
/// Threads: any.
void LogInfo(const std::string& text);
void LogWarning(const std::string& text);
void LogError(const std::string& text);

/// Sets the name in front of the lines.
void SetLogName(const std::string& name);

}  // namespace terra::bus
