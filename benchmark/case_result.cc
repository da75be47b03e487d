#include "benchmark/case_result.h"

#include <array>
#include <charconv>
#include <fstream>
#include <span>
#include <utility>

#include "terrain/files/csv.h"
#include "terrain/route_text.h"

namespace terra::benchmark {
namespace {

using verifier::Code;

constexpr std::array<std::string_view, 25> kColumns = {"case_id",
                                                       "group",
                                                       "sequence",
                                                       "map_id",
                                                       "repeat",
                                                       "kind",
                                                       "code",
                                                       "form",
                                                       "baseline_cost",
                                                       "oracle_cost",
                                                       "candidate_cost",
                                                       "final_cost",
                                                       "candidate_route",
                                                       "final_route",
                                                       "t_prep",
                                                       "t_llm",
                                                       "t_det",
                                                       "tries",
                                                       "tokens_in",
                                                       "tokens_out",
                                                       "spend",
                                                       "request_hash",
                                                       "candidates",
                                                       "candidates_lower",
                                                       "candidates_invalid"};
constexpr std::size_t kNumUsual = 22;

constexpr std::array<std::string_view, 5> kKinds = {
    "propose", "retain", "malformed", "no_answer", "no_baseline"};
constexpr std::array<std::string_view, 3> kForms = {"", "exact", "tolerated"};

// The codes that a result can have.
constexpr std::array<Code, 12> kCodes = {
    Code::kNotChecked,    Code::kAccepted,     Code::kRetained,
    Code::kFeasible,      Code::kParseError,   Code::kTooFewWaypoints,
    Code::kStartMismatch, Code::kGoalMismatch, Code::kOutOfBounds,
    Code::kObstacle,      Code::kWorkLimit,    Code::kNotCheaper};

// Reads the fields of one row in order of kColumns; remembers the first fault.
class RowReader {
 public:
  explicit RowReader(std::span<const std::string> fields) : fields_(fields) {}

  void Text(std::string& to) { to = fields_[at_++]; }

  template <typename Integer>
  void Int(Integer& to) {
    const std::string& field = fields_[at_++];
    const char* end = field.data() + field.size();
    const auto [stop, failed] = std::from_chars(field.data(), end, to);
    if (failed != std::errc() || stop != end) Fault();
  }

  void Number(double& to) {
    const Result<double> value = ParseNumber(fields_[at_++]);
    if (!value.ok() || *value < 0) return Fault();
    to = *value;
  }

  void Waypoints(Route& to) {
    const std::string& field = fields_[at_++];
    if (field.empty()) return;
    Result<Route> route = ParseRoute(field);
    if (!route.ok()) return Fault();
    to = *std::move(route);
  }

  // The index of the field among the names.
  template <std::size_t n>
  std::size_t Choice(const std::array<std::string_view, n>& names) {
    const std::string& field = fields_[at_++];
    for (std::size_t i = 0; i < n; ++i) {
      if (names[i] == field) return i;
    }
    Fault();
    return 0;
  }

  Code CodeField() {
    const std::string& field = fields_[at_++];
    for (const Code code : kCodes) {
      if (verifier::CodeName(code) == field) return code;
    }
    Fault();
    return Code::kNotChecked;
  }

  // The column with the first fault; -1 = none.
  int fault() const { return fault_; }

 private:
  void Fault() {
    if (fault_ < 0) fault_ = static_cast<int>(at_) - 1;
  }

  std::span<const std::string> fields_;
  std::size_t at_ = 0;
  int fault_ = -1;
};

}  // namespace

std::string_view AttemptKindName(AttemptKind kind) {
  return kKinds[static_cast<std::size_t>(kind)];
}

bool IsInvalidCode(Code code) {
  switch (code) {
    case Code::kParseError:
    case Code::kTooFewWaypoints:
    case Code::kStartMismatch:
    case Code::kGoalMismatch:
    case Code::kOutOfBounds:
    case Code::kObstacle:
    case Code::kWorkLimit:
      return true;
    default:
      return false;
  }
}

std::string ResultsHeader(ResultColumns columns) {
  const auto* end = columns == ResultColumns::kUsual
                        ? kColumns.begin() + kNumUsual
                        : kColumns.end();
  return CsvLine({kColumns.begin(), end});
}

std::string ResultLine(const CaseResult& r, ResultColumns columns) {
  const auto route = [](const Route& waypoints) {
    return waypoints.empty() ? "" : FormatRoute(waypoints);
  };
  std::vector<std::string> fields = {
      r.case_id,
      r.group,
      r.sequence,
      std::to_string(r.map_id),
      std::to_string(r.repeat),
      std::string(AttemptKindName(r.kind)),
      std::string(verifier::CodeName(r.code)),
      std::string(kForms[static_cast<std::size_t>(r.form)]),
      FormatNumber(r.baseline_cost),
      FormatNumber(r.oracle_cost),
      FormatNumber(r.candidate_cost),
      FormatNumber(r.final_cost),
      route(r.candidate_route),
      route(r.final_route),
      FormatNumber(r.t_prep),
      FormatNumber(r.t_llm),
      FormatNumber(r.t_det),
      std::to_string(r.tries),
      std::to_string(r.tokens_in),
      std::to_string(r.tokens_out),
      FormatNumber(r.spend),
      r.request_hash};
  if (columns == ResultColumns::kWithCandidates) {
    for (const int count :
         {r.candidates, r.candidates_lower, r.candidates_invalid}) {
      fields.push_back(std::to_string(count));
    }
  }
  return CsvLine(fields);
}

Result<CaseResult> ParseResultLine(std::string_view line,
                                   const std::string& path, int number) {
  const Result<CsvRow> parsed = ParseCsvRecord(line, path, number);
  if (!parsed.ok()) return parsed.error();
  const CsvRow& row = *parsed;
  if (row.fields.size() != kNumUsual && row.fields.size() != kColumns.size()) {
    return Error{ErrorCode::kInvalid, path + ":" + std::to_string(number) +
                                          ": not the columns of the header"};
  }
  CaseResult r;
  RowReader reader(row.fields);
  reader.Text(r.case_id);
  reader.Text(r.group);
  reader.Text(r.sequence);
  reader.Int(r.map_id);
  reader.Int(r.repeat);
  r.kind = static_cast<AttemptKind>(reader.Choice(kKinds));
  r.code = reader.CodeField();
  r.form = static_cast<AnswerStyle>(reader.Choice(kForms));
  reader.Number(r.baseline_cost);
  reader.Number(r.oracle_cost);
  reader.Number(r.candidate_cost);
  reader.Number(r.final_cost);
  reader.Waypoints(r.candidate_route);
  reader.Waypoints(r.final_route);
  reader.Number(r.t_prep);
  reader.Number(r.t_llm);
  reader.Number(r.t_det);
  reader.Int(r.tries);
  reader.Int(r.tokens_in);
  reader.Int(r.tokens_out);
  reader.Number(r.spend);
  reader.Text(r.request_hash);
  if (row.fields.size() > kNumUsual) {
    reader.Int(r.candidates);
    reader.Int(r.candidates_lower);
    reader.Int(r.candidates_invalid);
  }
  if (reader.fault() < 0) return r;
  const auto column = static_cast<std::size_t>(reader.fault());
  return Error{ErrorCode::kInvalid, path + ":" + std::to_string(number) +
                                        ": '" + row.fields[column] +
                                        "' is no " +
                                        std::string(kColumns[column])};
}

}  // namespace terra::benchmark
