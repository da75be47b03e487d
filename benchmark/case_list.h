#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "terrain/files/case_reader.h"
#include "terrain/files/dataset.h"
#include "terrain/files/id_index.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// Which of N equal parts of the cases: every N-th from the index-th on.
struct Shard {
  int index = 1;  ///< From 1.
  int count = 1;

  /// How many of so many cases are in it.
  std::int64_t NumOf(std::int64_t cases) const {
    return (cases + count - index) / count;
  }
};

/// Which cases of a dataset, always in its order. Without anything: all.
struct CaseSelection {
  int first_of_each_group = 0;   ///< 0 = all of them.
  std::vector<std::string> ids;  ///< Empty = whatever they are called.
};

/// The cases of a run. Nothing of them is in memory.
struct CaseList {
  std::string folder;  ///< Of the dataset.
  CaseSelection selection;
  Shard shard;
};

/// Decides case after case, in order of the dataset, which are selected.
class CaseFilter {
 public:
  /// `selection` must outlive it.
  explicit CaseFilter(const CaseSelection& selection);

  bool Takes(const DatasetCase& c);
  /// The first of the selected ids that no case had; none = all were there.
  std::optional<std::string> FirstMissing() const;

 private:
  int first_of_each_group_;
  IdIndex ids_;
  std::vector<bool> seen_;
  std::map<std::string, int> taken_;  ///< By group.
};

/// Reads the cases of a list one by one. `list` must outlive it.
class CaseCursor {
 public:
  static Result<CaseCursor> Open(const CaseList& list);

  /// The next case; none at the end. Errors: as CaseReader::Next.
  Result<std::optional<DatasetCase>> Next();

 private:
  CaseCursor(const CaseList& list, CaseReader reader);

  CaseFilter filter_;
  Shard shard_;
  CaseReader reader_;
  std::int64_t num_selected_ = 0;
};

/// Calls `use` with the ids of a list of cases, in their order and as often as
/// it is asked. An error of `use` ends it.
using CaseIds = std::function<Status(
    const std::function<Status(const std::string& case_id)>& use)>;
CaseIds IdsOf(const CaseList& list);

/// What is known of a dataset's cases when all were read once.
struct CaseSurvey {
  std::int64_t num_selected = 0;
  std::string case_list_digest;  ///< SHA-256 of the selected ids, a line each.
  /// As DatasetDigest; behind it the rule for unknown ground, where the user
  /// gave one.
  std::string dataset_digest;
};

/// Reads all cases. Errors: those of CheckCases; a selected id that no case
/// has.
Result<CaseSurvey> SurveyCases(const DatasetFolder& dataset,
                               const CaseSelection& selection);

/// What identifies a dataset: its own digest, else one of its table.
Result<std::string> DatasetDigest(const DatasetFolder& dataset);

}  // namespace terra::benchmark
