#include "benchmark/results_reader.h"

namespace terra::benchmark {

Result<ResultsReader> ResultsReader::Open(const std::string& path) {
  ResultsReader reader(path, std::ifstream(path, std::ios::binary));
  reader.TakeLine();
  if (reader.line_ != ResultsHeader() &&
      reader.line_ != ResultsHeader(ResultColumns::kWithCandidates)) {
    return Error{ErrorCode::kInvalid,
                 path + ":1: this is not the header of a results.csv"};
  }
  return reader;
}

Result<std::optional<CaseResult>> ResultsReader::Next() {
  const int number = place_.line;
  if (!TakeLine()) return std::optional<CaseResult>();
  Result<CaseResult> row = ParseResultLine(line_, path_, number);
  if (!row.ok()) return row.error();
  return std::optional(*std::move(row));
}

void ResultsReader::GoTo(Place place) {
  place_ = place;
  file_.clear();
  file_.seekg(place.offset);
}

bool ResultsReader::TakeLine() {
  if (!std::getline(file_, line_)) return false;
  line_ += '\n';
  place_.offset += static_cast<std::int64_t>(line_.size());
  ++place_.line;
  return true;
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
