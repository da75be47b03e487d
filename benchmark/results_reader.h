#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "benchmark/case_result.h"
#include "terrain/files/line_reader.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// Reads a results.csv of either form row by row.
class ResultsReader {
 public:
  /// Errors: as LineReader; another header.
  static Result<ResultsReader> Open(const std::string& path);

  /// The next row; none at the end. Errors: name file and line.
  Result<std::optional<CaseResult>> Next();

  /// The last row as it stands in the file, with its line end.
  const std::string& line() const { return lines_.line(); }

  /// Where the next row begins, and to go on from there.
  LineReader::Place place() const { return lines_.place(); }
  void GoTo(LineReader::Place place) { lines_.GoTo(place); }

 private:
  ResultsReader(std::string path, LineReader lines)
      : path_(std::move(path)), lines_(std::move(lines)) {}

  std::string path_;
  LineReader lines_;
};

/// Calls `use` with each row. Errors: those of ResultsReader.
Status ReadResults(const std::string& path,
                   const std::function<void(CaseResult)>& use);

}  // namespace terra::benchmark
