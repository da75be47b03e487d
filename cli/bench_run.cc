#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "advisor/llm_options.h"
#include "advisor/llm_service.h"
#include "advisor/prompt.h"
#include "base/secrets.h"
#include "benchmark/llm_method.h"
#include "benchmark/run.h"
#include "bus/build_id.h"
#include "bus/map_file_options.h"
#include "cli/bench_commands.h"
#include "cli/case_selection.h"
#include "cli/legend_notice.h"
#include "cli/map_arguments.h"
#include "cli/output.h"
#include "terrain/files/csv.h"
#include "terrain/files/dataset.h"
#include "terrain/files/whole_file.h"

namespace terra::cli {
namespace {

namespace fs = std::filesystem;
using benchmark::MethodRun;

struct RunArguments {
  std::string dataset;
  UnknownGround unknown;
  std::string method;
  std::vector<std::string> backends;
  bool gate = false;
  bool polish = false;
  advisor::LlmBackendOptions llm;
  std::string cases;
  benchmark::RunOptions options;
  std::string shard = "1/1";
  std::string out;
};

// Of the form I/N.
std::optional<benchmark::Shard> ParseShard(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return std::nullopt;
  const Result<int> index = ParseInteger(text.substr(0, slash));
  const Result<int> count = ParseInteger(text.substr(slash + 1));
  if (!index.ok() || !count.ok() || *index < 1 || *index > *count) {
    return std::nullopt;
  }
  return benchmark::Shard{*index, *count};
}

bool AsksModel(const std::string& backend) {
  const auto& names = advisor::kLlmBackendNames;
  return std::find(names.begin(), names.end(), backend) != names.end();
}

Result<MethodRun> ChooseMethod(const RunArguments& arguments,
                               const std::string& backend,
                               const std::string& folder) {
  if (!AsksModel(backend)) {
    auto choice = benchmark::FindDeterministicMethod(arguments.method, backend,
                                                     arguments.gate);
    if (!choice.ok()) return choice.error();
    return MethodRun{*std::move(choice), folder, "{}"};
  }
  const bool single_search = arguments.method == "llm-astar-single";
  const auto method =
      advisor::FindMethod(single_search ? "llm-astar" : arguments.method);
  if (!method) {
    return Error{ErrorCode::kInvalid,
                 "a model is asked by method advisor, direct, llm-astar or "
                 "llm-astar-single, not by " +
                     arguments.method};
  }
  advisor::LlmBackendOptions options = arguments.llm;
  options.service.backend = backend;
  options.method.method = *method;
  auto made = benchmark::MakeLlmMethod(
      options, {arguments.polish, arguments.gate, single_search});
  if (!made.ok()) return made.error();
  return MethodRun{std::move(made->choice), folder,
                   std::move(made->settings_json)};
}

// One run per backend; with several each gets a folder of its own.
Result<std::vector<MethodRun>> ChooseMethods(const RunArguments& arguments) {
  std::vector<MethodRun> runs;
  std::vector<std::string> backends = arguments.backends;
  if (backends.empty()) backends.emplace_back();
  for (const std::string& backend : backends) {
    const fs::path folder = backends.size() == 1
                                ? fs::path(arguments.out)
                                : fs::path(arguments.out) / backend;
    Result<MethodRun> run = ChooseMethod(arguments, backend, folder.string());
    if (!run.ok()) return run.error();
    runs.push_back(*std::move(run));
  }
  return runs;
}

int RunRun(RunArguments& arguments, const std::string& command_line) {
  const Result<DatasetFolder> dataset =
      OpenDataset(arguments.dataset, arguments.unknown);
  if (!dataset.ok()) return Fail(dataset.error());
  NoteHowMapsAreRead(*dataset);
  auto cases = SelectCases(arguments.cases);
  if (!cases.ok()) return Fail(cases.error());
  arguments.options.cases = *std::move(cases);
  const auto runs = ChooseMethods(arguments);
  if (!runs.ok()) return Fail(runs.error());
  ForgetApiKeys();
  for (const MethodRun& run : *runs) {
    // A model is asked one case after the other; shards run side by side.
    if (run.choice.info.asks_model) arguments.options.jobs = 1;
  }
  const Status done = benchmark::RunMethods(*dataset, arguments.options, *runs,
                                            {bus::BuildId(), command_line});
  if (!done.ok()) return Fail(done.error());
  for (const MethodRun& run : *runs) {
    std::cout << run.folder << ": " << TitleWithGate(run.choice.info) << "\n";
  }
  return kDone;
}

std::string MethodHelp() {
  std::string text =
      "advisor; direct or llm-astar with a model; or without a backend: ";
  for (const std::string& name : benchmark::PlainMethodNames()) {
    text += name + " ";
  }
  return text;
}

std::string BackendHelp() {
  std::string text = "Several with commas. Of advisor, without a model: ";
  for (const std::string& name : benchmark::RefinerNames()) text += name + " ";
  text += "; with one: ";
  for (const std::string_view name : advisor::kLlmBackendNames) {
    text += std::string(name) + " ";
  }
  return text;
}

void AddOptions(CLI::App& command, RunArguments& arguments) {
  // The method is this command's own, and everybody is asked about every case.
  advisor::AddExperimentOptions(command, arguments.llm.method);
  advisor::AddLlmOptions(command, arguments.llm);
  command.remove_option(command.get_option("--method"));
  command.remove_option(command.get_option("--min-gain"));
  command.add_option("--dataset", arguments.dataset, "Dataset folder")
      ->required()
      ->type_name("DIR");
  command.add_option("--method", arguments.method, MethodHelp())
      ->required()
      ->type_name("M");
  command.add_option("--backend", arguments.backends, BackendHelp())
      ->delimiter(',')
      ->type_name("B");
  command.add_flag("--gate", arguments.gate,
                   "Give a method without fallback one: the final route is "
                   "the baseline where its own is no better");
  command.add_flag("--polish", arguments.polish,
                   "advisor with a model: improve each route inside a corridor "
                   "around it before it is verified");
  AddCasesOption(command, arguments.cases);
  command
      .add_option("--repeats", arguments.options.repeats,
                  "Ask each case K times (default 1)")
      ->check(CLI::Range(1, 1000))
      ->type_name("K");
  command
      .add_option("--shard", arguments.shard,
                  "Only every N-th case from the I-th on; merge the folders "
                  "with `terra bench merge`")
      ->check([](const std::string& text) {
        return ParseShard(text) ? std::string() : "must be I/N, 1 <= I <= N";
      })
      ->type_name("I/N");
  command
      .add_option("--out", arguments.out,
                  "Folder of the results; a run that was interrupted goes on")
      ->required()
      ->type_name("DIR");
  AddStrideOption(command, arguments.options.lattice.stride);
  AddJointsOption(command, arguments.options.lattice.joints);
  AddCostModelOptions(command, arguments.options.cost_model);
  bus::AddUnknownOption(command, arguments.unknown);
  AddJobsOption(command, arguments.options.jobs);
}

}  // namespace

void AddBenchRun(CLI::App& bench, int& exit_code) {
  CLI::App& command =
      *bench.add_subcommand("run", "Run a method over a dataset");
  const auto arguments = std::make_shared<RunArguments>();
  AddOptions(command, *arguments);
  command.footer(
      "Example:\n"
      "  terra bench run --dataset data --method advisor --backend "
      "search,shortcut --out runs\n"
      "  terra bench run --dataset data --method coarse --out runs/coarse\n"
      "  terra bench run --dataset data --method direct --backend replay "
      "--recording calls.jsonl --out runs/direct");
  command.callback([arguments, &exit_code] {
    arguments->options.shard = *ParseShard(arguments->shard);
    exit_code = RunRun(*arguments, CommandLine());
  });
}

}  // namespace terra::cli
