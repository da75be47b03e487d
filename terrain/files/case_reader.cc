#include "terrain/files/case_reader.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "terrain/files/ascii_case.h"

namespace terra {
namespace {

namespace fs = std::filesystem;

bool IsExtraColumn(const std::string& column) {
  return std::find(kCaseColumns.begin(), kCaseColumns.end(), column) ==
         kCaseColumns.end();
}

// A dataset may come from elsewhere: its maps must lie in its own folder.
bool StaysInside(const std::string& relative) {
  const fs::path path(relative);
  return !relative.empty() && path.is_relative() &&
         std::find(path.begin(), path.end(), "..") == path.end();
}

// Finds hashes that come twice. What is too much for one go is done in parts,
// by the hashes' last bits.
class DoubleFinder {
 public:
  // The memory is touched as it is used.
  explicit DoubleFinder(std::size_t at_once) : at_once_(at_once) {
    kept_.reserve(at_once);
  }

  // While the first part is gone through there may become more of them.
  void Add(std::uint64_t hash) {
    if (hash % parts_ != part_) return;
    kept_.push_back(hash);
    if (part_ != 0 || kept_.size() < at_once_) return;
    TakeDoubles();
    if (kept_.size() < at_once_ / 2) return;
    parts_ *= 2;
    std::erase_if(kept_, [&](std::uint64_t h) {
      return h % parts_ != 0;
    });
  }

  void FinishPart() {
    TakeDoubles();
    kept_.clear();
    ++part_;
  }

  bool HasMoreParts() const { return part_ < parts_; }
  const std::unordered_set<std::uint64_t>& doubles() const { return doubles_; }

 private:
  // Leaves one of each. A few doubles are enough for a complaint.
  void TakeDoubles() {
    constexpr std::size_t kEnough = 1000;
    std::sort(kept_.begin(), kept_.end());
    for (std::size_t i = 1; i < kept_.size(); ++i) {
      const bool twice = kept_[i - 1] == kept_[i];
      if (twice && doubles_.size() < kEnough) doubles_.insert(kept_[i]);
    }
    kept_.erase(std::unique(kept_.begin(), kept_.end()), kept_.end());
  }

  std::size_t at_once_;
  std::uint64_t parts_ = 1;
  std::uint64_t part_ = 0;
  std::vector<std::uint64_t> kept_;
  std::unordered_set<std::uint64_t> doubles_;
};

// Calls `use` with each case and its line.
template <typename Use>
Status ForEachCase(const std::string& folder, Use use) {
  Result<CaseReader> reader = CaseReader::Open(folder);
  if (!reader.ok()) return reader.error();
  for (;;) {
    Result<std::optional<DatasetCase>> next = reader->Next();
    if (!next.ok()) return next.error();
    if (!next->has_value()) return Done{};
    const Status used = use(**std::move(next), reader->line());
    if (!used.ok()) return used;
  }
}

std::string TablePath(const std::string& folder) {
  return (fs::path(folder) / "cases.csv").string();
}

// Two ids may have one hash: the ids themselves decide.
Status RefuseDoubles(const std::string& folder,
                     const std::unordered_set<std::uint64_t>& hashes) {
  if (hashes.empty()) return Done{};
  std::unordered_set<std::string> seen;
  return ForEachCase(folder, [&](const DatasetCase& c, int line) -> Status {
    if (!hashes.contains(HashOfId(c.case_id))) return Done{};
    if (seen.insert(c.case_id).second) return Done{};
    return Error{ErrorCode::kInvalid, TablePath(folder) + ":" +
                                          std::to_string(line) + ": case_id '" +
                                          c.case_id + "' comes twice"};
  });
}

}  // namespace

CaseReader::CaseReader(std::string path, CsvReader rows)
    : path_(std::move(path)), rows_(std::move(rows)) {}

Result<CaseReader> CaseReader::Open(const std::string& dataset_folder) {
  std::string path = TablePath(dataset_folder);
  Result<CsvReader> rows = CsvReader::Open(
      path, {"case_id", "map", "start_x", "start_y", "goal_x", "goal_y"});
  if (!rows.ok()) return rows.error();
  return CaseReader(std::move(path), *std::move(rows));
}

Result<std::optional<DatasetCase>> CaseReader::Next() {
  Result<std::optional<CsvRow>> row = rows_.Next();
  if (!row.ok()) return row.error();
  if (!row->has_value()) return std::optional<DatasetCase>();
  line_ = (*row)->line;
  Result<DatasetCase> parsed = Parse(**std::move(row));
  if (!parsed.ok()) return parsed.error();
  return std::optional(*std::move(parsed));
}

Result<DatasetCase> CaseReader::Parse(CsvRow row) const {
  const CsvTable& table = rows_.table();
  const auto fail = [&](const std::string& what) {
    return Error{ErrorCode::kInvalid,
                 path_ + ":" + std::to_string(row.line) + ": " + what};
  };
  DatasetCase result;
  std::array<int*, 4> numbers = {&result.start.x, &result.start.y,
                                 &result.goal.x, &result.goal.y};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::string_view column = kCaseColumns[i + 2];
    const Result<int> value = ParseInteger(
        row.fields[static_cast<std::size_t>(table.Column(column))]);
    if (!value.ok()) {
      return fail(std::string(column) + ": " + value.error().message);
    }
    *numbers[i] = *value;
  }
  for (std::size_t i = 0; i < row.fields.size(); ++i) {
    const std::string& column = table.header[i];
    std::string& field = row.fields[i];
    if (column == "case_id") {
      result.case_id = std::move(field);
    } else if (column == "map") {
      result.map = std::move(field);
    } else if (EqualsInAnyCase(column, "group")) {
      result.group = std::move(field);
    } else if (IsExtraColumn(column)) {
      result.extra[column] = std::move(field);
    }
  }
  if (result.case_id.empty()) return fail("empty case_id");
  if (result.case_id.find('\n') != std::string::npos) {
    return fail("a case_id with a line break");
  }
  if (!StaysInside(result.map)) {
    return fail("map '" + result.map +
                "' must be a path inside the dataset's folder");
  }
  return result;
}

Status CheckCases(const std::string& dataset_folder,
                  const std::function<void(DatasetCase)>& use,
                  std::size_t ids_at_once) {
  DoubleFinder finder(ids_at_once);
  const Status first =
      ForEachCase(dataset_folder, [&](DatasetCase c, int) -> Status {
        finder.Add(HashOfId(c.case_id));
        use(std::move(c));
        return Done{};
      });
  if (!first.ok()) return first;
  for (finder.FinishPart(); finder.HasMoreParts(); finder.FinishPart()) {
    const Status next =
        ForEachCase(dataset_folder, [&](const DatasetCase& c, int) -> Status {
          finder.Add(HashOfId(c.case_id));
          return Done{};
        });
    if (!next.ok()) return next;
  }
  return RefuseDoubles(dataset_folder, finder.doubles());
}

}  // namespace terra
