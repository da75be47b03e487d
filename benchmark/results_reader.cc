#include "benchmark/results_reader.h"

namespace terra::benchmark {

Result<ResultsReader> ResultsReader::Open(const std::string& path) {
  Result<LineReader> lines = LineReader::Open(path);
  if (!lines.ok()) return lines.error();
  const Result<bool> header = lines->Next();
  if (!header.ok()) return header.error();
  if (lines->line() != ResultsHeader() &&
      lines->line() != ResultsHeader(ResultColumns::kWithCandidates)) {
    return Error{ErrorCode::kInvalid,
                 path + ":1: this is not the header of a results.csv"};
  }
  return ResultsReader(path, *std::move(lines));
}

Result<std::optional<CaseResult>> ResultsReader::Next() {
  const int number = place().line;
  const Result<bool> taken = lines_.Next();
  if (!taken.ok()) return taken.error();
  if (!*taken) return std::optional<CaseResult>();
  Result<CaseResult> row = ParseResultLine(line(), path_, number);
  if (!row.ok()) return row.error();
  return std::optional(*std::move(row));
}

Status ReadResults(const std::string& path,
                   const std::function<void(CaseResult)>& use) {
  Result<ResultsReader> reader = ResultsReader::Open(path);
  if (!reader.ok()) return reader.error();
  for (;;) {
    Result<std::optional<CaseResult>> row = reader->Next();
    if (!row.ok()) return row.error();
    if (!row->has_value()) return Done{};
    use(**std::move(row));
  }
}

}  // namespace terra::benchmark
