#pragma once

#include <cstdint>

namespace terra::advisor {

/// What an advisor's answer comes to. Numbers are those of advice_t.
enum class AnswerKind : std::int8_t {
  kRetain = 1,     ///< The baseline stays; no attempt.
  kPropose = 2,    ///< At least one route.
  kMalformed = 3,  ///< An attempt that is no route.
  kFailed = 4,     ///< No answer came; no attempt.
};

/// Did the answer have exactly the form asked for (white space aside)?
enum class AnswerForm : std::int8_t { kNone = 0, kExact = 1, kTolerated = 2 };

}  // namespace terra::advisor
