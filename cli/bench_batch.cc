#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "advisor/llm_options.h"
#include "benchmark/batch.h"
#include "bus/map_file_options.h"
#include "cli/bench_commands.h"
#include "cli/case_selection.h"
#include "cli/legend_notice.h"
#include "cli/map_arguments.h"
#include "cli/output.h"

namespace terra::cli {
namespace {

struct ExportArguments {
  std::string dataset;
  advisor::LlmBackendOptions llm;
  std::string cases;
  benchmark::RunOptions options;
  benchmark::BatchFolder folder;
  UnknownGround unknown;
  bool json = false;
};

struct ImportArguments {
  std::string folder;
  std::vector<std::string> results;
  std::vector<std::string> prices;
  std::string recording;
  bool json = false;
};

int RunExport(ExportArguments& arguments) {
  const Result<DatasetFolder> dataset =
      OpenDataset(arguments.dataset, arguments.unknown);
  if (!dataset.ok()) return Fail(dataset.error());
  NoteHowMapsAreRead(*dataset);
  auto cases = SelectCases(arguments.cases);
  if (!cases.ok()) return Fail(cases.error());
  arguments.options.cases = *std::move(cases);
  const auto written = benchmark::ExportBatch(*dataset, arguments.options,
                                              arguments.llm, arguments.folder);
  if (!written.ok()) return Fail(written.error());
  if (arguments.json) {
    const nlohmann::ordered_json json = {
        {"requests", written->requests},
        {"left_out", written->left_out},
        {"without_baseline", written->without_baseline},
        {"files", written->files}};
    std::cout << json.dump(-1, ' ', false,
                           nlohmann::ordered_json::error_handler_t::replace)
              << "\n";
    return kDone;
  }
  for (const std::string& file : written->files) std::cout << file << "\n";
  std::cout << written->requests << " requests, " << written->left_out
            << " left out, " << written->without_baseline
            << " cases without a baseline\n";
  return kDone;
}

void PrintImported(const benchmark::ImportedBatch& batch) {
  constexpr std::size_t kMostFailures = 10;
  for (std::size_t i = 0; i < batch.failures.size(); ++i) {
    if (i == kMostFailures) {
      std::cerr << "terra: ... and " << batch.failures.size() - i << " more\n";
      break;
    }
    std::cerr << "terra: " << batch.failures[i] << "\n";
  }
  std::cout << batch.imported << " answers imported, " << batch.known
            << " known before, " << batch.failed << " failed, " << batch.missing
            << " without a result, " << batch.foreign << " foreign, "
            << batch.doubled << " doubled\n";
}

int RunImport(const ImportArguments& arguments) {
  advisor::PriceTable prices;
  for (const std::string& price : arguments.prices) {
    if (const Status added = prices.Add(price); !added) {
      return Fail(added.error());
    }
  }
  const auto batch = benchmark::ImportBatch(arguments.folder, arguments.results,
                                            arguments.recording, prices);
  if (!batch.ok()) return Fail(batch.error());
  if (arguments.json) {
    const nlohmann::ordered_json json = {
        {"imported", batch->imported}, {"known", batch->known},
        {"failed", batch->failed},     {"missing", batch->missing},
        {"foreign", batch->foreign},   {"doubled", batch->doubled},
        {"failures", batch->failures}};
    std::cout << json.dump(-1, ' ', false,
                           nlohmann::ordered_json::error_handler_t::replace)
              << "\n";
  } else {
    PrintImported(*batch);
  }
  return batch->imported + batch->known > 0 ? kDone : kCouldNot;
}

}  // namespace

void AddBenchExportBatch(CLI::App& bench, int& exit_code) {
  CLI::App& command = *bench.add_subcommand(
      "export-batch", "Write a dataset's questions as a provider's batch");
  const auto arguments = std::make_shared<ExportArguments>();
  command.add_option("--dataset", arguments->dataset, "Dataset folder")
      ->required()
      ->type_name("DIR");
  command
      .add_option("--backend", arguments->llm.service.backend,
                  "openai, anthropic or gemini")
      ->required()
      ->check(CLI::IsMember({"openai", "anthropic", "gemini"}))
      ->type_name("B");
  advisor::AddExperimentOptions(command, arguments->llm.method);
  advisor::AddPromptOptions(command, arguments->llm.method,
                            arguments->llm.references);
  advisor::AddSettingsOptions(command,
                              arguments->llm.service.provider.settings);
  AddCasesOption(command, arguments->cases);
  command
      .add_option("--repeats", arguments->options.repeats,
                  "Ask each case K times (default 1)")
      ->check(CLI::Range(1, 1000))
      ->type_name("K");
  AddStrideOption(command, arguments->options.lattice.stride);
  AddJointsOption(command, arguments->options.lattice.joints);
  AddCostModelOptions(command, arguments->options.cost_model);
  bus::AddUnknownOption(command, arguments->unknown);
  command
      .add_option("--except", arguments->folder.except,
                  "Leave out what this recording has an answer to")
      ->check(CLI::ExistingFile)
      ->type_name("F.jsonl");
  command.add_flag("--images,!--no-images", arguments->folder.images,
                   "Keep the pictures beside (default)");
  command.add_option("--out", arguments->folder.path, "Folder to write")
      ->required()
      ->type_name("DIR");
  command.add_flag("--json", arguments->json, "Print JSON");
  command.footer(
      "Example:\n"
      "  terra bench export-batch --dataset data --backend anthropic --out "
      "batch\n"
      "Send the requests-*.json* to the provider; what it gives back goes to "
      "`terra bench import-batch`. docs/advisor.md has the commands.");
  command.callback([arguments, &exit_code] {
    exit_code = RunExport(*arguments);
  });
}

void AddBenchImportBatch(CLI::App& bench, int& exit_code) {
  CLI::App& command = *bench.add_subcommand(
      "import-batch", "Read a batch's results into a recording");
  const auto arguments = std::make_shared<ImportArguments>();
  command
      .add_option("--batch", arguments->folder,
                  "Folder that export-batch wrote")
      ->required()
      ->type_name("DIR");
  command
      .add_option("--results", arguments->results,
                  "Result and error files of the provider (JSON lines)")
      ->required()
      ->type_name("F...");
  command.add_option("--price", arguments->prices,
                     "MODEL=INPUT:OUTPUT of the batch, dollars per million "
                     "tokens; repeatable");
  command
      .add_option("--recording", arguments->recording,
                  "Recording to add the answers to")
      ->required()
      ->type_name("F.jsonl");
  command.add_flag("--json", arguments->json, "Print JSON");
  command.footer(
      "Example:\n"
      "  terra bench import-batch --batch batch --results results.jsonl "
      "--recording calls.jsonl\n"
      "  terra bench run --dataset data --method advisor --backend replay "
      "--recording calls.jsonl --out runs/advisor");
  command.callback([arguments, &exit_code] {
    exit_code = RunImport(*arguments);
  });
}

}  // namespace terra::cli
