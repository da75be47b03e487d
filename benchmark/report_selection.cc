#include "benchmark/report_selection.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "benchmark/run_labels.h"

namespace terra::benchmark {
namespace {

constexpr int kPaperStride = 50;

using Runs = std::vector<LoadedRun>;

template <typename Predicate>
Runs Select(const Runs& runs, Predicate wanted) {
  Runs selected;
  for (const LoadedRun& run : runs) {
    if (wanted(run)) selected.push_back(run);
  }
  return selected;
}

// The largest set (in rows) of runs that stand together with one of them.
// Errors: those of `together`.
template <typename Together>
Result<Runs> LargestSet(const Runs& runs, Together together) {
  Runs best;
  std::int64_t best_rows = 0;
  for (const LoadedRun& first : runs) {
    Runs set;
    std::int64_t rows = 0;
    for (const LoadedRun& run : runs) {
      const Result<bool> fits = together(first, run);
      if (!fits.ok()) return fits.error();
      if (!*fits) continue;
      set.push_back(run);
      rows += run.num_rows;
    }
    if (rows > best_rows) {
      best_rows = rows;
      best = std::move(set);
    }
  }
  return best;
}

Result<bool> AreComparable(const LoadedRun& a, const LoadedRun& b,
                           const std::set<Shared>& varies) {
  const auto mismatch = FindMismatch(a, b, varies);
  if (!mismatch.ok()) return mismatch.error();
  return !mismatch->has_value();
}

Result<Runs> LargestComparable(const Runs& runs,
                               const std::set<Shared>& varies = {}) {
  return LargestSet(runs, [&](const LoadedRun& a, const LoadedRun& b) {
    return AreComparable(a, b, varies);
  });
}

// Runs over different lists of cases on the cases that all have.
Result<Runs> LargestOnCommonCases(const Runs& runs) {
  Result<Runs> set = LargestComparable(runs, {Shared::kCaseList});
  if (!set.ok()) return set;
  const Status kept = KeepCommonCases(*set);
  if (!kept.ok()) return kept.error();
  const bool any = !set->empty() && set->front().num_rows > 0;
  return any ? set : LargestComparable(runs);
}

Result<Runs> Largest(const Runs& runs, CaseLists lists) {
  return lists == CaseLists::kCommon ? LargestOnCommonCases(runs)
                                     : LargestComparable(runs);
}

bool HasDouble(const Runs& runs, const LoadedRun& run) {
  return std::any_of(runs.begin(), runs.end(), [&](const LoadedRun& other) {
    return run.description.SameRow(other.description);
  });
}

// Of two runs that are one row.
bool SaysMore(const LoadedRun& a, const LoadedRun& b) {
  const auto rank = [](const LoadedRun& run) {
    return std::pair(run.complete(), run.description.jobs == 1);
  };
  return rank(a) > rank(b);
}

// Parts the runs that no other table has, nor a double of them, into sets of
// comparable ones.
Result<std::vector<Runs>> SelectOthers(const Runs& runs, const Selection& s) {
  Runs shown;
  for (const Runs* table : {&s.comparison, &s.gap, &s.joints, &s.rugd,
                            &s.latency, &s.ablation, &s.noise}) {
    shown.insert(shown.end(), table->begin(), table->end());
  }
  std::vector<Runs> others;
  for (const LoadedRun& run : WithoutDoubles(runs)) {
    if (HasDouble(shown, run)) continue;
    Runs* set = nullptr;
    for (Runs& other : others) {
      const Result<bool> fits = AreComparable(other.front(), run, {});
      if (!fits.ok()) return fits.error();
      if (*fits && set == nullptr) set = &other;
    }
    if (set == nullptr) set = &others.emplace_back();
    set->push_back(run);
  }
  return others;
}

// Runs on the maps of the main comparison that differ from it in what varies.
Result<Runs> Beside(const LoadedRun& main, const Runs& runs,
                    std::set<Shared> varies, CaseLists lists) {
  if (lists == CaseLists::kCommon) varies.insert(Shared::kCaseList);
  Runs beside;
  for (const LoadedRun& run : runs) {
    const Result<bool> fits = AreComparable(main, run, varies);
    if (!fits.ok()) return fits.error();
    if (*fits) beside.push_back(run);
  }
  if (lists == CaseLists::kCommon) {
    const Status kept = KeepCommonCases(beside);
    if (!kept.ok()) return kept.error();
  }
  return WithoutDoubles(beside);
}

// Puts the runs of a table, without doubles, where they belong.
Status Put(const Result<Runs>& runs, Runs& place) {
  if (!runs.ok()) return runs.error();
  place = WithoutDoubles(*runs);
  return Done{};
}

// Tables that follow the maps of the main comparison.
Status SelectBeside(const LoadedRun& main, const Runs& plain, CaseLists lists,
                    Selection& s) {
  const Status gap =
      Put(Beside(main,
                 Select(plain,
                        [](const LoadedRun& run) {
                          return IsOfGap(run) &&
                                 run.description.method == "advisor";
                        }),
                 {Shared::kStride}, lists),
          s.gap);
  if (!gap.ok()) return gap;
  return Put(Beside(main,
                    Select(plain,
                           [](const LoadedRun& run) {
                             return run.description.method == "coarse";
                           }),
                    {Shared::kJoints}, lists),
             s.joints);
}

// Tables whose runs may have different lists of cases.
Status SelectOnCommonCases(const Runs& generated, Selection& s) {
  const Status latency =
      Put(LargestOnCommonCases(Select(generated,
                                      [](const LoadedRun& run) {
                                        return IsPlain(run) &&
                                               run.description.jobs == 1;
                                      })),
          s.latency);
  if (!latency.ok()) return latency;
  return Put(LargestOnCommonCases(Select(generated, IsOfNoise)), s.noise);
}

Status SelectMain(const Runs& plain, CaseLists lists, Selection& s) {
  const Status put =
      Put(Largest(Select(plain,
                         [](const LoadedRun& run) {
                           const RunDescription& d = run.description;
                           return d.stride == kPaperStride && d.joints == "2r";
                         }),
                  lists),
          s.comparison);
  if (!put.ok() || s.comparison.empty()) return put;
  s.paired = s.comparison;
  std::stable_partition(s.paired.begin(), s.paired.end(),
                        [](const LoadedRun& run) {
                          return run.description.method == "corridor";
                        });
  return SelectBeside(s.comparison.front(), plain, lists, s);
}

int RowRank(const LoadedRun& run) {
  const RunDescription& d = run.description;
  if (d.method == "coarse") return 0;
  if (d.asks_model) return 1;
  if (d.method == "advisor") return d.backend == "search" ? 5 : 2;
  if (d.method == "oracle") return 6;
  return d.title.rfind("control", 0) == 0 ? 4 : 3;
}

}  // namespace

Runs WithoutDoubles(const Runs& runs) {
  Runs once;
  for (const LoadedRun& run : runs) {
    const auto same =
        std::find_if(once.begin(), once.end(), [&](const LoadedRun& other) {
          return run.description.SameRow(other.description);
        });
    if (same == once.end()) {
      once.push_back(run);
    } else if (SaysMore(run, *same)) {
      *same = run;
    }
  }
  return once;
}

Result<Selection> SelectRuns(const Runs& runs, CaseLists lists) {
  const Runs generated = Select(runs, IsGenerated);
  Selection s;
  s.all = runs;
  for (const Status& selected :
       {SelectMain(Select(generated, IsPlain), lists, s),
        Put(Largest(Select(Select(runs, IsRugd),
                           [](const LoadedRun& run) {
                             return IsPlain(run) &&
                                    run.description.stride == kPaperStride;
                           }),
                    lists),
            s.rugd),
        Put(Largest(Select(generated, IsOfAblation), lists), s.ablation),
        SelectOnCommonCases(generated, s)}) {
    if (!selected.ok()) return selected.error();
  }
  Result<std::vector<Runs>> others = SelectOthers(runs, s);
  if (!others.ok()) return others.error();
  s.others = *std::move(others);
  return s;
}

void SortRows(std::vector<LoadedRun>& runs) {
  std::stable_sort(runs.begin(), runs.end(),
                   [](const LoadedRun& a, const LoadedRun& b) {
                     return RowRank(a) < RowRank(b);
                   });
}

}  // namespace terra::benchmark
