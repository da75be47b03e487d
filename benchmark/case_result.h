#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "terrain/cell.h"
#include "terrain/legend.h"
#include "terrain/result.h"
#include "verifier/verify.h"

namespace terra::benchmark {

/// What a method did with a case.
enum class AttemptKind : std::uint8_t {
  kPropose,     ///< It gave a route, which was verified.
  kRetain,      ///< It kept the baseline: no attempt.
  kMalformed,   ///< Something came that is no route: an invalid attempt.
  kNoAnswer,    ///< Nothing came; asked again when the run is resumed.
  kNoBaseline,  ///< The lattice has no route: not in N_Path.
};

/// How an answer was written; kNone where nothing was read.
enum class AnswerStyle : std::uint8_t { kNone, kExact, kTolerated };

/// A row of results.csv; docs/benchmark.md defines the columns. Costs are
/// kImpassable (`inf`) where there is no valid route; times in seconds.
struct CaseResult {
  std::string case_id;
  std::string group;
  std::string sequence;
  std::int64_t map_id = 0;
  int repeat = 0;
  AttemptKind kind = AttemptKind::kNoAnswer;
  verifier::Code code = verifier::Code::kNotChecked;
  AnswerStyle form = AnswerStyle::kNone;
  double baseline_cost = kImpassable;
  double oracle_cost = kImpassable;
  double candidate_cost = kImpassable;
  double final_cost = kImpassable;
  Route candidate_route;
  Route final_route;
  double t_prep = 0;
  double t_llm = 0;
  double t_det = 0;
  int tries = 0;
  std::int64_t tokens_in = 0;
  std::int64_t tokens_out = 0;
  double spend = 0;  ///< US dollars; kImpassable = not known.
  std::string request_hash;
  // Of answers that may have several candidates.
  int candidates = 0;
  int candidates_lower = 0;    ///< Valid and cheaper than the baseline.
  int candidates_invalid = 0;  ///< Parse, count, end, border or obstacle.

  friend bool operator==(const CaseResult&, const CaseResult&) = default;
};

std::string_view AttemptKindName(AttemptKind kind);

/// Is the attempt, or a candidate of it, an invalid one: parse, count, end,
/// border or obstacle?
bool IsInvalidCode(verifier::Code code);

/// The columns of a results.csv: those of the candidates are there only where
/// an answer may have several.
enum class ResultColumns : std::uint8_t { kUsual, kWithCandidates };

/// The header line of results.csv and one line, with their line ends.
std::string ResultsHeader(ResultColumns columns = ResultColumns::kUsual);
std::string ResultLine(const CaseResult& result,
                       ResultColumns columns = ResultColumns::kUsual);

/// Reads one line, with or without its end. Errors: name the file and the
/// number of the line.
Result<CaseResult> ParseResultLine(std::string_view line,
                                   const std::string& path, int number);

}  // namespace terra::benchmark
