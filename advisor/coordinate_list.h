#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "terrain/cell.h"

namespace terra::advisor {

/// Why an answer, or one list of it, could not be read.
enum class AnswerFault {
  kNone,
  kEmpty,           ///< Nothing but white space.
  kTooLong,         ///< More bytes than allowed.
  kYesNotAlone,     ///< A Yes with words or a list beside it.
  kNoList,          ///< No Yes, and no coordinate list.
  kEmptyList,       ///< `[]`.
  kNotAnInteger,    ///< A coordinate with a fraction, exponent, sign +, letter.
  kNumberTooLong,   ///< More than 9 digits.
  kNotAPair,        ///< A point without two coordinates.
  kUnexpectedText,  ///< Something else inside the list, an ellipsis say.
  kUnclosedList,    ///< The answer ends inside the list.
  kTooManyWaypoints,
};

/// Returns "not_an_integer", ... as printed and documented.
std::string_view FaultName(AnswerFault fault);

/// One list of an answer.
struct AnswerCandidate {
  Route waypoints;  ///< As written, unchecked against any map.
  AnswerFault fault = AnswerFault::kNone;  ///< Then waypoints is empty.
  std::size_t position = 0;  ///< Byte of the answer where the fault is.
};

/// Does a list begin at this byte? `[` before a point's bracket or its own end;
/// other brackets only when a number follows too, because words use them as
/// well. Pre: at < text.size().
bool ListBegins(std::string_view text, std::size_t at);

/// Reads the list that begins at `at`; `at` moves past what was read.
/// Pre: ListBegins.
AnswerCandidate ReadList(std::string_view text, std::size_t max_waypoints,
                         std::size_t& at);

/// Reads the first row of at least two points that has no outer brackets. A
/// point that is cut or no pair of integers spoils its row.
std::optional<AnswerCandidate> ReadBareRow(std::string_view text,
                                           std::size_t max_waypoints);

}  // namespace terra::advisor
