#include "benchmark/report.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "advisor/encoding.h"
#include "benchmark/panels.h"
#include "benchmark/paper_tables.h"
#include "benchmark/plots.h"
#include "benchmark/report_page.h"
#include "benchmark/run.h"
#include "terrain/files/whole_file.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

constexpr int kPaperStride = 50;
constexpr int kPanelsPerGroup = 3;

bool HasGroup(const LoadedRun& run, const std::string& group) {
  const std::vector<std::string> groups = GroupsOf(run);
  return std::find(groups.begin(), groups.end(), group) != groups.end();
}

bool IsGenerated(const LoadedRun& run) {
  return HasGroup(run, "easy") || HasGroup(run, "hard");
}

bool IsRugd(const LoadedRun& run) {
  return HasGroup(run, "creek") || HasGroup(run, "park") ||
         HasGroup(run, "trail") || HasGroup(run, "village");
}

template <typename Predicate>
std::vector<LoadedRun> Select(const std::vector<LoadedRun>& runs,
                              Predicate wanted) {
  std::vector<LoadedRun> selected;
  for (const LoadedRun& run : runs) {
    if (wanted(run)) selected.push_back(run);
  }
  return selected;
}

// The largest set of runs that can stand in one table.
std::vector<LoadedRun> LargestComparable(const std::vector<LoadedRun>& runs) {
  std::vector<LoadedRun> best;
  std::size_t best_cases = 0;
  for (const LoadedRun& first : runs) {
    std::vector<LoadedRun> set = Select(runs, [&](const LoadedRun& run) {
      return WhyNotComparable(first, run).empty();
    });
    std::size_t cases = 0;
    for (const LoadedRun& run : set) cases += run.scores.size();
    if (cases > best_cases) {
      best_cases = cases;
      best = std::move(set);
    }
  }
  return best;
}

bool SameCases(const LoadedRun& a, const LoadedRun& b) {
  return a.description.dataset_digest == b.description.dataset_digest &&
         a.description.case_list_digest == b.description.case_list_digest;
}

// The order of rows: baseline, models, refiners, methods as they return, then
// controls, then the bounds that no method passes.
int RowRank(const LoadedRun& run) {
  const RunDescription& d = run.description;
  if (d.method == "coarse") return 0;
  if (d.asks_model) return 1;
  if (d.method == "advisor") return d.backend == "search" ? 5 : 2;
  if (d.method == "oracle") return 6;
  return d.title.rfind("control", 0) == 0 ? 4 : 3;
}

// Which run stands in which table.
struct Selection {
  std::vector<LoadedRun> comparison;
  std::vector<LoadedRun> gap;
  std::vector<LoadedRun> joints;
  std::vector<LoadedRun> rugd;
  std::vector<LoadedRun> latency;
  std::vector<LoadedRun> models;  ///< Ablation and noise.
  /// Sets of comparable runs that stand in no table above.
  std::vector<std::vector<LoadedRun>> others;
};

// Parts the runs that no other table has into sets of comparable ones.
std::vector<std::vector<LoadedRun>> SelectOthers(
    const std::vector<LoadedRun>& runs, const Selection& s) {
  std::set<std::string> shown;
  for (const auto* table :
       {&s.comparison, &s.gap, &s.joints, &s.rugd, &s.latency}) {
    for (const LoadedRun& run : *table) shown.insert(run.folder);
  }
  std::vector<std::vector<LoadedRun>> others;
  for (const LoadedRun& run : runs) {
    if (shown.contains(run.folder)) continue;
    const auto set = std::find_if(
        others.begin(), others.end(), [&](const std::vector<LoadedRun>& o) {
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

Selection SelectRuns(const std::vector<LoadedRun>& runs) {
  Selection s;
  const auto plain = Select(runs, IsPlain);
  s.comparison = LargestComparable(Select(plain, [](const LoadedRun& run) {
    return IsGenerated(run) && run.description.stride == kPaperStride &&
           run.description.joints == "2r";
  }));
  s.rugd = LargestComparable(Select(plain, [](const LoadedRun& run) {
    return IsRugd(run) && run.description.stride == kPaperStride;
  }));
  s.latency = Select(plain, [](const LoadedRun& run) {
    return IsGenerated(run) && run.description.jobs == 1;
  });
  s.models = Select(runs, [](const LoadedRun& run) {
    return IsGenerated(run) && run.description.asks_model;
  });
  if (s.comparison.empty()) {
    s.others = SelectOthers(runs, s);
    return s;
  }
  const LoadedRun& main = s.comparison.front();
  s.gap = Select(plain, [&](const LoadedRun& run) {
    return SameCases(run, main) && run.description.method == "advisor" &&
           run.description.joints == "2r";
  });
  s.joints = Select(plain, [&](const LoadedRun& run) {
    return SameCases(run, main) && run.description.stride == kPaperStride;
  });
  s.others = SelectOthers(runs, s);
  return s;
}

// A file that the report is made of, below its folder.
struct Output {
  std::string path;
  std::string content;
};

class ReportWriter {
 public:
  explicit ReportWriter(const ReportOptions& options) : options_(options) {}

  Status Write(const std::vector<LoadedRun>& runs) {
    const Selection s = SelectRuns(runs);
    page_.Intro(runs);
    Comparison(s.comparison);
    Gaps(s);
    page_.Section("Ablation, noise, latency",
                  "These rows need a model. They are measured by the commands "
                  "shown, or reproduced from a recording.");
    Add(AblationTable(s.models));
    Add(NoiseTable(s.models));
    Add(LatencyTable(s.latency));
    page_.Section("RUGD",
                  "Semantic masks of camera frames as cost rasters: how the "
                  "methods transfer.");
    Add(RugdTable(s.rugd));
    Others(s.others);
    const Status pictures = Pictures(s);
    if (!pictures.ok()) return pictures.error();
    page_.Section("What produced these figures", "");
    Add(RunsTable(runs));
    outputs_.push_back({"report.html", page_.Finish()});
    return WriteOutputs();
  }

 private:
  void Add(const Table& table) {
    page_.Html(ToHtml(table));
    outputs_.push_back({"tables/" + table.id + ".csv", ToCsv(table)});
    outputs_.push_back({"tables/" + table.id + ".md", ToMarkdown(table)});
    outputs_.push_back({"tables/" + table.id + ".tex", ToLatex(table)});
  }

  void Plot(const std::string& name, const std::string& caption,
            const std::string& svg) {
    if (svg.empty()) return;
    page_.Figure(svg, caption);
    outputs_.push_back({"figures/" + name + ".svg", svg});
  }

  void Comparison(const std::vector<LoadedRun>& runs) {
    page_.Section(
        "Main comparison",
        "Every method on the same cases, scored by the one verifier. With "
        "fallback a method deploys its route only when it is verified as "
        "strictly cheaper than the baseline; without it whatever it returned "
        "stands.");
    for (const std::string group : {"easy", "hard"}) {
      Add(ComparisonTable(runs, group));
      Plot("fir-" + group,
           "Final improvement rate with 95 % interval, " + group +
               " subset. Blue: advisors; grey: references and controls.",
           FirPlot(runs, group));
    }
    for (const std::string group : {"easy", "hard"}) {
      Add(ProposalTable(runs, group));
      Plot("mogr-" + group,
           "Mean share of the oracle gap that is recovered, " + group +
               " subset.",
           MogrPlot(runs, group));
    }
    // Against the control without a model: gains mean something beside it.
    std::vector<LoadedRun> ordered = runs;
    std::stable_partition(ordered.begin(), ordered.end(),
                          [](const LoadedRun& run) {
                            return run.description.method == "corridor";
                          });
    for (const std::string group : {"easy", "hard"}) {
      Add(PairedTable(ordered, group));
    }
  }

  void Gaps(const Selection& s) {
    page_.Section("Oracle gap",
                  "What the coarse lattice costs more than the native optimum, "
                  "and how much of that a method wins back.");
    Add(OracleGapTable(s.gap));
    Plot("gap-by-stride", "Mean gap by lattice stride.", GapPlot(s.gap));
    Add(JointsTable(s.joints));
  }

  void Others(const std::vector<std::vector<LoadedRun>>& others) {
    if (others.empty()) return;
    page_.Section("Other runs",
                  "Runs that stand in no table above: other datasets, case "
                  "lists, strides or switches. Recordings for tests are among "
                  "them; their README says what they are.");
    int number = 0;
    for (const std::vector<LoadedRun>& set : others) {
      for (const std::string& group : GroupsOf(set.front())) {
        Table table = ProposalTable(set, group);
        table.id = "other-" + std::to_string(++number);
        const RunDescription& d = set.front().description;
        table.title =
            (d.dataset_name.empty() ? "Unnamed dataset" : d.dataset_name) +
            (group.empty() ? "" : ", " + group) + ", stride " +
            std::to_string(d.stride) + ", joints " + d.joints;
        Add(table);
      }
    }
  }

  Status Pictures(const Selection& s) {
    page_.Section("Examples",
                  "Grey: the lattice. Blue: baseline. Green: the deployed "
                  "route. Cases at even distances in the order of what was "
                  "gained.");
    for (const std::string& folder : options_.datasets) {
      const Result<Dataset> dataset = ReadDataset(folder);
      if (!dataset.ok()) return dataset.error();
      const Result<std::string> digest = DatasetDigest(*dataset);
      if (!digest.ok()) return digest.error();
      const LoadedRun* run = PictureRun(s, *digest);
      if (run == nullptr) continue;
      const auto panels = MakePanels(run->folder, *dataset, kPanelsPerGroup);
      if (!panels.ok()) return panels.error();
      AddPanels(*run, *panels);
    }
    return Done{};
  }

  // A model's run when there is one, else a refiner's that is no bound.
  static const LoadedRun* PictureRun(const Selection& s,
                                     const std::string& digest) {
    const LoadedRun* best = nullptr;
    for (const auto* runs : {&s.models, &s.comparison, &s.rugd}) {
      for (const LoadedRun& run : *runs) {
        if (run.description.dataset_digest != digest ||
            run.description.method != "advisor") {
          continue;
        }
        const bool shortcut = run.description.backend == "shortcut";
        if (best == nullptr || run.description.asks_model ||
            (shortcut && !best->description.asks_model)) {
          best = &run;
        }
      }
    }
    return best;
  }

  void AddPanels(const LoadedRun& run, const std::vector<Panel>& panels) {
    page_.BeginPanels(RowTitle(run));
    int number = 0;
    for (const Panel& panel : panels) {
      page_.AddPanel(panel.caption, advisor::Base64Encode(panel.png));
      outputs_.push_back({"figures/panel-" + run.description.dataset_name +
                              "-" + std::to_string(++number) + ".png",
                          panel.png});
    }
    page_.EndPanels();
  }

  Status WriteOutputs() const {
    std::error_code failed;
    for (const char* folder : {"tables", "figures"}) {
      fs::create_directories(fs::path(options_.out) / folder, failed);
      if (failed) {
        return Error{ErrorCode::kUnavailable,
                     options_.out + ": " + failed.message()};
      }
    }
    for (const Output& output : outputs_) {
      const Status written = WriteWholeFile(
          (fs::path(options_.out) / output.path).string(), output.content);
      if (!written.ok()) return written.error();
    }
    return Done{};
  }

  const ReportOptions& options_;
  ReportPage page_;
  std::vector<Output> outputs_;
};

}  // namespace

Status WriteReport(const ReportOptions& options) {
  Result<std::vector<LoadedRun>> runs = LoadRuns(options.runs);
  if (!runs.ok()) return runs.error();
  if (!options.include_simulated) {
    std::erase_if(*runs, [](const LoadedRun& run) {
      return run.description.simulated;
    });
  }
  std::stable_sort(runs->begin(), runs->end(),
                   [](const LoadedRun& a, const LoadedRun& b) {
                     return RowRank(a) < RowRank(b);
                   });
  return ReportWriter(options).Write(*runs);
}

}  // namespace terra::benchmark
