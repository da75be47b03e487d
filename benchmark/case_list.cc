#include "benchmark/case_list.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>

#include "advisor/encoding.h"
#include "terrain/files/whole_file.h"

namespace terra::benchmark {

namespace fs = std::filesystem;

CaseFilter::CaseFilter(const CaseSelection& selection)
    : first_of_each_group_(selection.first_of_each_group),
      ids_(IndexOf(selection.ids)),
      seen_(selection.ids.size()) {}

bool CaseFilter::Takes(const DatasetCase& c) {
  if (!seen_.empty()) {
    const std::optional<std::size_t> place = ids_.Find(c.case_id);
    if (!place) return false;
    seen_[*place] = true;
  }
  return first_of_each_group_ == 0 || taken_[c.group]++ < first_of_each_group_;
}

std::optional<std::string> CaseFilter::FirstMissing() const {
  const auto missing = std::find(seen_.begin(), seen_.end(), false);
  if (missing == seen_.end()) return std::nullopt;
  return ids_[static_cast<std::size_t>(missing - seen_.begin())];
}

CaseCursor::CaseCursor(const CaseList& list, CaseReader reader)
    : filter_(list.selection), shard_(list.shard), reader_(std::move(reader)) {}

Result<CaseCursor> CaseCursor::Open(const CaseList& list) {
  Result<CaseReader> reader = CaseReader::Open(list.folder);
  if (!reader.ok()) return reader.error();
  return CaseCursor(list, *std::move(reader));
}

Result<std::optional<DatasetCase>> CaseCursor::Next() {
  for (;;) {
    Result<std::optional<DatasetCase>> next = reader_.Next();
    if (!next.ok() || !next->has_value()) return next;
    if (!filter_.Takes(**next)) continue;
    if (num_selected_++ % shard_.count + 1 == shard_.index) return next;
  }
}

CaseIds IdsOf(const CaseList& list) {
  return
      [&list](const std::function<Status(const std::string&)>& use) -> Status {
        Result<CaseCursor> cursor = CaseCursor::Open(list);
        if (!cursor.ok()) return cursor.error();
        for (;;) {
          const Result<std::optional<DatasetCase>> next = cursor->Next();
          if (!next.ok()) return next.error();
          if (!next->has_value()) return Done{};
          const Status used = use((*next)->case_id);
          if (!used.ok()) return used;
        }
      };
}

Result<CaseSurvey> SurveyCases(const DatasetFolder& dataset,
                               const CaseSelection& selection) {
  CaseSurvey survey;
  CaseFilter filter(selection);
  advisor::Sha256 list;
  const Status checked = CheckCases(dataset.folder, [&](const DatasetCase& c) {
    if (!filter.Takes(c)) return;
    ++survey.num_selected;
    list.Add(c.case_id);
    list.Add("\n");
  });
  if (!checked.ok()) return checked.error();
  if (const std::optional<std::string> missing = filter.FirstMissing()) {
    return Error{ErrorCode::kInvalid,
                 dataset.folder + ": has no case '" + *missing + "'"};
  }
  survey.case_list_digest = list.Hex();
  Result<std::string> digest = DatasetDigest(dataset);
  if (!digest.ok()) return digest.error();
  survey.dataset_digest = *std::move(digest);
  // With another cost of unknown ground its maps are others.
  const std::string unknown = ToText(dataset.unknown);
  if (!unknown.empty()) survey.dataset_digest += " --unknown " + unknown;
  return survey;
}

Result<std::string> DatasetDigest(const DatasetFolder& dataset) {
  if (!dataset.digest.empty()) return dataset.digest;
  const std::string path = (fs::path(dataset.folder) / "cases.csv").string();
  Result<std::ifstream> file = OpenToRead(path);
  if (!file.ok()) return file.error();
  advisor::Sha256 digest;
  std::string part(std::size_t{1} << 16, '\0');
  while (*file) {
    file->read(part.data(), static_cast<std::streamsize>(part.size()));
    digest.Add({part.data(), static_cast<std::size_t>(file->gcount())});
  }
  if (file->bad()) {
    return Error{ErrorCode::kUnavailable, path + ": cannot be read"};
  }
  return "cases.csv:" + digest.Hex();
}

}  // namespace terra::benchmark
