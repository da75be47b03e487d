#pragma once

#include <functional>
#include <optional>
#include <string>

#include "terrain/files/csv.h"
#include "terrain/files/dataset.h"
#include "terrain/result.h"

namespace terra {

/// Reads the cases of a dataset one by one, so that there may be any number.
class CaseReader {
 public:
  /// Opens the folder's cases.csv. Errors: as CsvReader::Open.
  static Result<CaseReader> Open(const std::string& dataset_folder);

  /// The next case; none at the end. Errors: name file and line; a case without
  /// an id or with one of two lines, a number that is none, a map that is not
  /// inside the folder.
  Result<std::optional<DatasetCase>> Next();

  /// Where the last case stands in the file.
  int line() const { return line_; }

 private:
  CaseReader(std::string path, CsvReader rows);

  Result<DatasetCase> Parse(CsvRow row) const;

  std::string path_;
  CsvReader rows_;
  int line_ = 1;
};

/// How many ids CheckCases keeps at a time, in 8 bytes each (128 MB).
inline constexpr std::size_t kMaxIdsAtOnce = std::size_t{1} << 24;

/// Reads all cases, calls `use` for each in their order, and looks for an id
/// that comes twice. Memory is bounded: of more than `ids_at_once` ids a part
/// is compared at a time, and the file read once more for each other part.
/// Errors: those of CaseReader; a case_id that comes twice, with its line.
Status CheckCases(const std::string& dataset_folder,
                  const std::function<void(DatasetCase)>& use,
                  std::size_t ids_at_once = kMaxIdsAtOnce);

}  // namespace terra
