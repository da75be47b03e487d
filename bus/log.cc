#include "bus/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace terra::bus {

void LogInfo(const std::string& text) {
  spdlog::info("{}", text);
}
void LogWarning(const std::string& text) {
  spdlog::warn("{}", text);
}
void LogError(const std::string& text) {
  spdlog::error("{}", text);
}

void SetLogName(const std::string& name) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt(name));
  spdlog::set_pattern("%Y-%m-%d %H:%M:%S.%e %n %l: %v");
}

}  // namespace terra::bus
