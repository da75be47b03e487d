#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "benchmark/case_result.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// Reads a results.csv of either form row by row.
class ResultsReader {
 public:
  /// Errors: it cannot be read; another header.
  static Result<ResultsReader> Open(const std::string& path);

  /// The next row; none at the end. Errors: name file and line.
  Result<std::optional<CaseResult>> Next();

  /// The last row as it stands in the file, with its line end.
  const std::string& line() const { return line_; }

  /// A row of the file: its first byte, and the number of its line.
  struct Place {
    std::int64_t offset = 0;
    int line = 1;
  };
  /// Where the next row begins, and to go on from there.
  Place place() const { return place_; }
  void GoTo(Place place);

 private:
  ResultsReader(std::string path, std::ifstream file)
      : path_(std::move(path)), file_(std::move(file)) {}

  bool TakeLine();

  std::string path_;
  std::ifstream file_;
  std::string line_;
  Place place_;
};

/// Calls `use` with each row. Errors: those of ResultsReader.
Status ReadResults(const std::string& path,
                   const std::function<void(CaseResult)>& use);

}  // namespace terra::benchmark
