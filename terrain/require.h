#pragma once

#include <stdexcept>
#include <string>

namespace terra {

/// Throws std::logic_error: the caller broke a precondition, which is a bug in
/// this program and never the fault of an input.
[[noreturn]] inline void FailRequirement(const char* condition,
                                         const char* file, int line) {
  throw std::logic_error(std::string(file) + ":" + std::to_string(line) +
                         ": requirement not met: " + condition);
}

}  // namespace terra

/// Checks a precondition in every build.
#define TERRA_REQUIRE(condition)                                \
  do {                                                          \
    if (!(condition)) {                                         \
      ::terra::FailRequirement(#condition, __FILE__, __LINE__); \
    }                                                           \
  } while (false)
