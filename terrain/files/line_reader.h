#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <utility>

#include "terrain/result.h"

namespace terra {

/// Reads a text file line by line, in bounded memory.
class LineReader {
 public:
  /// The most bytes of a line; whole answers of models stand in one.
  static constexpr std::size_t kMaxLineBytes = std::size_t{1} << 26;

  /// Errors: as OpenToRead.
  static Result<LineReader> Open(const std::string& path);

  /// Takes the next line; false at the end. Errors: name file and line; a line
  /// of more than kMaxLineBytes, a file that cannot be read.
  Result<bool> Next();

  /// The last line, with its line feed unless the file ends without one.
  const std::string& line() const { return line_; }

  /// A line of the file: its first byte, and its number.
  struct Place {
    std::int64_t offset = 0;
    int line = 1;
  };
  /// Where the next line begins, and to go on from there.
  Place place() const { return place_; }
  void GoTo(Place place);

 private:
  LineReader(std::string path, std::ifstream file)
      : path_(std::move(path)), file_(std::move(file)) {}

  std::string path_;
  std::ifstream file_;
  std::string line_;
  Place place_;
};

}  // namespace terra
