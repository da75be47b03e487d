#include "benchmark/results_order.h"

#include <optional>
#include <utility>

#include "benchmark/results_reader.h"

namespace terra::benchmark {
namespace {

// Reads rows, the next one being known.
class RowCursor {
 public:
  static Result<RowCursor> Open(const std::string& path,
                                LineReader::Place place) {
    Result<ResultsReader> reader = ResultsReader::Open(path);
    if (!reader.ok()) return reader.error();
    if (place.offset > 0) reader->GoTo(place);
    RowCursor cursor(*std::move(reader));
    const Status read = cursor.Advance();
    if (!read.ok()) return read.error();
    return cursor;
  }

  bool AtEnd() const { return !row_.has_value(); }
  const CaseResult& row() const { return *row_; }
  const std::string& line() const { return reader_.line(); }
  /// Where row() begins.
  LineReader::Place place() const { return place_; }

  bool IsAt(const std::string& case_id, int repeat) const {
    return row_ && row_->repeat == repeat && row_->case_id == case_id;
  }

  Status Advance() {
    place_ = reader_.place();
    Result<std::optional<CaseResult>> next = reader_.Next();
    if (!next.ok()) return next.error();
    row_ = *std::move(next);
    return Done{};
  }

 private:
  explicit RowCursor(ResultsReader reader) : reader_(std::move(reader)) {}

  ResultsReader reader_;
  LineReader::Place place_;
  std::optional<CaseResult> row_;
};

// Passes over the rows that are in order from here on.
Status PassOrdered(const CaseIds& cases, int repeats, RowCursor& cursor) {
  return cases([&](const std::string& id) -> Status {
    for (int repeat = 0; repeat < repeats; ++repeat) {
      if (!cursor.IsAt(id, repeat)) continue;
      const Status next = cursor.Advance();
      if (!next.ok()) return next;
    }
    return Done{};
  });
}

// Calls `use` with the row of a case and repeat, if there is one.
Status TakeRow(const std::string& id, int repeat, std::int64_t slot,
               std::vector<RowCursor>& cursors,
               const std::function<void(const OrderedRow&)>& use) {
  RowCursor* last = nullptr;
  for (RowCursor& cursor : cursors) {
    if (cursor.IsAt(id, repeat)) last = &cursor;
  }
  if (last == nullptr) return Done{};
  use({slot, last->row(), last->line()});
  for (RowCursor& cursor : cursors) {
    if (!cursor.IsAt(id, repeat)) continue;
    const Status next = cursor.Advance();
    if (!next.ok()) return next;
  }
  return Done{};
}

}  // namespace

Result<SortedParts> FindSortedParts(const std::string& path,
                                    const CaseIds& cases, int repeats) {
  Result<RowCursor> cursor = RowCursor::Open(path, {});
  if (!cursor.ok()) return cursor.error();
  SortedParts parts;
  while (!cursor->AtEnd()) {
    if (parts.size() == kMaxSortedParts) {
      return Error{ErrorCode::kInvalid,
                   path + ": its rows are in no order of the cases"};
    }
    parts.push_back(cursor->place());
    const Status passed = PassOrdered(cases, repeats, *cursor);
    if (!passed.ok()) return passed.error();
    const bool none =
        !cursor->AtEnd() && cursor->place().offset == parts.back().offset;
    if (none) {
      return Error{ErrorCode::kInvalid,
                   path + ": case '" + cursor->row().case_id + "' repeat " +
                       std::to_string(cursor->row().repeat) +
                       " is not of this run"};
    }
  }
  return parts;
}

Status MergeSortedParts(const std::string& path, const SortedParts& parts,
                        const CaseIds& cases, int repeats,
                        const std::function<void(const OrderedRow&)>& use) {
  std::vector<RowCursor> cursors;
  for (const LineReader::Place place : parts) {
    Result<RowCursor> cursor = RowCursor::Open(path, place);
    if (!cursor.ok()) return cursor.error();
    cursors.push_back(*std::move(cursor));
  }
  if (cursors.empty()) return Done{};
  std::int64_t slot = 0;
  return cases([&](const std::string& id) -> Status {
    for (int repeat = 0; repeat < repeats; ++repeat, ++slot) {
      const Status taken = TakeRow(id, repeat, slot, cursors, use);
      if (!taken.ok()) return taken;
    }
    return Done{};
  });
}

}  // namespace terra::benchmark
