#include "benchmark/report.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "advisor/encoding.h"
#include "base/base64.h"
#include "base/html.h"
#include "benchmark/case_list.h"
#include "benchmark/detail_tables.h"
#include "benchmark/missing_rows.h"
#include "benchmark/named_tables.h"
#include "benchmark/panels.h"
#include "benchmark/plots.h"
#include "benchmark/report_page.h"
#include "benchmark/report_selection.h"
#include "benchmark/rugd.h"
#include "benchmark/run_labels.h"
#include "output/output_file.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;

constexpr int kPanelsPerGroup = 3;

// A file that the report is made of, below its folder.
struct Output {
  std::string path;
  std::string content;
};

class ReportWriter {
 public:
  /// `others`: what was found beside runs, a sentence each.
  ReportWriter(const ReportOptions& options,
               const std::vector<std::string>& others)
      : options_(options), others_(others) {}

  Status Write(const std::vector<LoadedRun>& runs) {
    const Result<Selection> selected = SelectRuns(runs);
    if (!selected.ok()) return selected.error();
    const Selection& s = *selected;
    page_.Intro(runs);
    MainComparison(s);
    Gaps(s);
    page_.Section("Ablation, noise, latency",
                  "Rows of a model are measured by the commands shown, or "
                  "reproduced from a recording. Latency rows are of runs that "
                  "took one case at a time, on the cases that all of them "
                  "have.");
    for (const char* name : {"ablation", "noise", "latency"}) AddNamed(name, s);
    page_.Section("RUGD",
                  "Semantic masks of camera frames as cost rasters: how the "
                  "methods transfer.");
    AddNamed("rugd", s);
    Others(s.others);
    const Status pictures = Pictures(s);
    if (!pictures.ok()) return pictures.error();
    page_.Section("What produced these figures", "");
    AddNamed("runs", s);
    for (const std::string& other : others_) {
      page_.Html("<p class=\"note\">Passed over: " + EscapeHtml(other) +
                 "</p>\n");
    }
    if (failure_) return *failure_;
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

  // A table that cannot be made ends the report when all are tried.
  void AddNamed(const std::string& name, const Selection& s) {
    const NamedTable& named = TableNamed(name);
    const Result<Table> table = named.make(s.*named.runs);
    if (table.ok()) {
      Add(*table);
    } else if (!failure_) {
      failure_ = table.error();
    }
  }

  void MainComparison(const Selection& s) {
    page_.Section(
        "Main comparison",
        "Every method on the same cases, scored by the one verifier. With "
        "fallback a method deploys its route only when it is verified as "
        "strictly cheaper than the baseline; without it whatever it returned "
        "stands.");
    for (const std::string& group : kSubsets) {
      AddNamed("comparison-" + group, s);
      Plot("fir-" + group,
           "Final improvement rate with 95 % interval, " + group +
               " subset. Blue: advisors; grey: references and controls.",
           FirPlot(s.comparison, group));
    }
    for (const std::string& group : kSubsets) {
      AddNamed("proposals-" + group, s);
      Plot("mogr-" + group,
           "Mean share of the oracle gap that is recovered, " + group +
               " subset.",
           MogrPlot(s.comparison, group));
    }
    for (const std::string& group : kSubsets) AddNamed("paired-" + group, s);
  }

  void Gaps(const Selection& s) {
    page_.Section("Oracle gap",
                  "What the coarse lattice costs more than the native optimum, "
                  "and how much of that a method wins back.");
    AddNamed("oracle-gap", s);
    Plot("gap-by-stride", "Mean gap by lattice stride.", GapPlot(s.gap));
    AddNamed("joints", s);
  }

  void Others(const std::vector<std::vector<LoadedRun>>& others) {
    if (others.empty()) return;
    page_.Section("Other runs",
                  "Runs that stand in no table above: other datasets, case "
                  "lists, strides or switches. Recordings for "
                  "tests are among "
                  "them; their README says what they are.");
    int number = 0;
    for (const std::vector<LoadedRun>& set : others) {
      for (const std::string& group : GroupsOf(set.front())) {
        Table table = ProposalTable(set, group);
        table.id = "other-" + std::to_string(++number);
        const RunDescription& d = set.front().description;
        table.title = DatasetTitle(d) + (group.empty() ? "" : ", " + group) +
                      ", stride " + std::to_string(d.stride) + ", joints " +
                      d.joints;
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
      const Result<DatasetFolder> dataset = OpenDataset(folder);
      if (!dataset.ok()) return dataset.error();
      const Result<std::string> digest = DatasetDigest(*dataset);
      if (!digest.ok()) return digest.error();
      const LoadedRun* run = PictureRun(s, *digest);
      if (run == nullptr) continue;
      const auto panels = MakePanels(run->folder, *dataset, kPanelsPerGroup,
                                     FramesOf(*dataset, *run));
      if (!panels.ok()) return panels.error();
      AddPanels(*run, *panels);
    }
    return Done{};
  }

  // Only frames of RUGD are meant.
  std::string FramesOf(const DatasetFolder& dataset,
                       const LoadedRun& run) const {
    if (!IsRugd(run)) return "";
    return options_.frames.empty() ? RugdFramesOf(dataset) : options_.frames;
  }

  // A model's run when there is one, else a refiner's that is no bound.
  static const LoadedRun* PictureRun(const Selection& s,
                                     const std::string& digest) {
    const LoadedRun* best = nullptr;
    for (const auto* runs : {&s.ablation, &s.comparison, &s.rugd}) {
      for (const LoadedRun& run : *runs) {
        if (run.description.dataset_digest != digest ||
            run.description.method != "advisor" || !IsPlain(run)) {
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
      page_.AddPanel(panel.caption, Base64Encode(panel.png));
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
  const std::vector<std::string>& others_;
  ReportPage page_;
  std::vector<Output> outputs_;
  std::optional<Error> failure_;
};

}  // namespace

Status WriteReport(const ReportOptions& options) {
  std::vector<std::string> others;
  Result<std::vector<LoadedRun>> runs = LoadRuns(options.runs, &others);
  if (!runs.ok()) return runs.error();
  if (!options.include_simulated) {
    std::erase_if(*runs, [](const LoadedRun& run) {
      return run.description.simulated;
    });
  }
  SortRows(*runs);
  return ReportWriter(options, others).Write(*runs);
}

}  // namespace terra::benchmark
