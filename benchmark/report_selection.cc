#include "benchmark/report_selection.h"

#include <algorithm>
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
template <typename Together>
Runs LargestSet(const Runs& runs, Together together) {
  Runs best;
  std::int64_t best_rows = 0;
  for (const LoadedRun& first : runs) {
    Runs set = Select(runs, [&](const LoadedRun& run) {
      return together(first, run);
    });
    std::int64_t rows = 0;
    for (const LoadedRun& run : set) rows += run.num_rows;
    if (rows > best_rows) {
      best_rows = rows;
      best = std::move(set);
    }
  }
  return best;
}

Runs LargestComparable(const Runs& runs) {
  return LargestSet(runs, [](const LoadedRun& a, const LoadedRun& b) {
    return WhyNotComparable(a, b).empty();
  });
}

bool SameMaps(const LoadedRun& a, const LoadedRun& b) {
  const RunDescription& x = a.description;
  const RunDescription& y = b.description;
  return x.dataset_digest == y.dataset_digest &&
         x.corner_cutting == y.corner_cutting &&
         x.clearance_cells == y.clearance_cells;
}

bool SameCases(const LoadedRun& a, const LoadedRun& b) {
  return SameMaps(a, b) &&
         a.description.case_list_digest == b.description.case_list_digest;
}

bool SameBaselines(const LoadedRun& a, const LoadedRun& b) {
  return SameMaps(a, b) && a.description.stride == b.description.stride &&
         a.description.joints == b.description.joints;
}

// Runs over different lists of cases on the cases that all have.
Result<Runs> LargestOnCommonCases(const Runs& runs) {
  Runs set = LargestSet(runs, SameBaselines);
  const Status kept = KeepCommonCases(set);
  if (!kept.ok()) return kept.error();
  const bool any = !set.empty() && set.front().num_rows > 0;
  return any ? set : LargestComparable(runs);
}

Runs WithoutDoubles(const Runs& runs) {
  Runs once;
  for (const LoadedRun& run : runs) {
    const auto same =
        std::find_if(once.begin(), once.end(), [&](const LoadedRun& other) {
          return run.description.SameFigures(other.description);
        });
    if (same == once.end()) {
      once.push_back(run);
    } else if (run.description.jobs == 1 && same->description.jobs != 1) {
      *same = run;
    }
  }
  return once;
}

bool HasDouble(const Runs& runs, const LoadedRun& run) {
  return std::any_of(runs.begin(), runs.end(), [&](const LoadedRun& other) {
    return run.description.SameFigures(other.description);
  });
}

// Parts the runs that no other table has, nor a double of them, into sets of
// comparable ones.
std::vector<Runs> SelectOthers(const Runs& runs, const Selection& s) {
  Runs shown;
  for (const Runs* table : {&s.comparison, &s.gap, &s.joints, &s.rugd,
                            &s.latency, &s.ablation, &s.noise}) {
    shown.insert(shown.end(), table->begin(), table->end());
  }
  std::vector<Runs> others;
  for (const LoadedRun& run : runs) {
    if (HasDouble(shown, run)) continue;
    const auto set =
        std::find_if(others.begin(), others.end(), [&](const Runs& o) {
          return WhyNotComparable(o.front(), run).empty();
        });
    if (set == others.end()) {
      others.push_back({run});
    } else {
      set->push_back(run);
    }
  }
  return others;
}

// Tables that follow the maps of the main comparison.
void SelectBeside(const LoadedRun& main, const Runs& plain, Selection& s) {
  s.gap = WithoutDoubles(Select(plain, [&](const LoadedRun& run) {
    return SameCases(run, main) && run.description.method == "advisor" &&
           run.description.joints == "2r";
  }));
  s.joints = WithoutDoubles(Select(plain, [&](const LoadedRun& run) {
    return SameCases(run, main) && run.description.method == "coarse" &&
           run.description.stride == kPaperStride;
  }));
}

// Tables whose runs may have different lists of cases.
Status SelectOnCommonCases(const Runs& generated, Selection& s) {
  const Result<Runs> latency =
      LargestOnCommonCases(Select(generated, [](const LoadedRun& run) {
        return IsPlain(run) && run.description.jobs == 1;
      }));
  if (!latency.ok()) return latency.error();
  const Result<Runs> noise =
      LargestOnCommonCases(Select(generated, [](const LoadedRun& run) {
        return IsAdvisedByModel(run) && HasAllSwitchesOn(run);
      }));
  if (!noise.ok()) return noise.error();
  s.latency = WithoutDoubles(*latency);
  s.noise = WithoutDoubles(*noise);
  return Done{};
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

Result<Selection> SelectRuns(const std::vector<LoadedRun>& runs) {
  const Runs generated = Select(runs, IsGenerated);
  const Runs plain = Select(generated, IsPlain);
  Selection s;
  s.comparison =
      WithoutDoubles(LargestComparable(Select(plain, [](const LoadedRun& run) {
        return run.description.stride == kPaperStride &&
               run.description.joints == "2r";
      })));
  if (!s.comparison.empty()) SelectBeside(s.comparison.front(), plain, s);
  s.rugd = WithoutDoubles(
      LargestComparable(Select(Select(runs, IsRugd), [](const LoadedRun& run) {
        return IsPlain(run) && run.description.stride == kPaperStride;
      })));
  s.ablation = WithoutDoubles(
      LargestComparable(Select(generated, [](const LoadedRun& run) {
        return IsAdvisedByModel(run) && SettingOf(run, "noise", "0") == "0";
      })));
  const Status selected = SelectOnCommonCases(generated, s);
  if (!selected.ok()) return selected.error();
  s.others = SelectOthers(runs, s);
  return s;
}

void SortRows(std::vector<LoadedRun>& runs) {
  std::stable_sort(runs.begin(), runs.end(),
                   [](const LoadedRun& a, const LoadedRun& b) {
                     return RowRank(a) < RowRank(b);
                   });
}

}  // namespace terra::benchmark
