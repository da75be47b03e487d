#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "advisor/answer_kind.h"
#include "advisor/coordinate_list.h"

namespace terra::advisor {

/// What kind of answer was asked for.
enum class AnswerStyle {
  kAdvice,  ///< `Yes`, or `No. [(x, y), ...]`.
  kRoute,   ///< `[(x, y), ...]` alone: a whole route, or intermediate targets.
};

/// What is read, and how much of it.
struct AnswerRules {
  AnswerStyle style = AnswerStyle::kAdvice;
  int max_candidates = 1;  ///< Lists read, in order; the rest is ignored.
  std::size_t max_bytes = 65'536;
  std::size_t max_waypoints = 2'048;  ///< Per list.
};

/// What an answer says: a canonical Yes (kRetain), at least the first list
/// (kPropose), or no readable first list (kMalformed).
struct Answer {
  AnswerKind kind = AnswerKind::kMalformed;
  AnswerForm form = AnswerForm::kTolerated;
  AnswerFault fault = AnswerFault::kEmpty;  ///< kNone unless kMalformed.
  std::size_t position = 0;                 ///< Byte where the fault is.
  /// In the order written; later ones may have faults of their own. Empty
  /// unless kPropose.
  std::vector<AnswerCandidate> candidates;
};

/// Reads a model's answer: strict about what it means, tolerant about how it
/// is written. White space is what Unicode says it is, spaces of no width too.
///
/// Yes:  after removal of white space, code fences, `*`, quotes and one full
///       stop the whole answer must be `yes` in any case; else it is none.
/// List: `[(x, y), ...]` with free white space; also other brackets, a code
///       fence, words around it, a missing `No.`, a comma before the end. A
///       list that begins must be sound to its end: integers only, never
///       rounded. Lists that follow a `No` directly go before others; a row of
///       points without outer brackets is read only where no list is. A word
///       `yes` anywhere beside a list contradicts it.
/// Bounded: linear in the answer's length, for any bytes. Threads: reentrant.
/// Source: paper, LLM-Advisor (prompt).
Answer ParseAnswer(std::string_view text, const AnswerRules& rules = {});

/// Is there nothing in it but white space, as ParseAnswer reads it?
bool IsBlankAnswer(std::string_view text);

}  // namespace terra::advisor
