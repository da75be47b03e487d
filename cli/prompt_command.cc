#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "advisor/llm_backend.h"
#include "advisor/llm_methods.h"
#include "advisor/llm_options.h"
#include "cli/baseline.h"
#include "cli/commands.h"
#include "cli/map_arguments.h"
#include "cli/output.h"
#include "output/output_file.h"
#include "terrain/digest.h"

namespace terra::cli {
namespace {

struct PromptArguments {
  ProblemArguments problem;
  BaselineArguments baseline;
  advisor::MethodOptions method;
  std::string references;
  std::string case_id;
  std::string out;
  bool json = false;
};

struct Prepared {
  advisor::PreparedCase question;
  double seconds = 0;
};

Result<Prepared> Prepare(const PromptArguments& arguments) {
  const ProblemArguments& problem = arguments.problem;
  const Result<TerrainMap> map = LoadMap(problem.map);
  if (!map.ok()) return map.error();
  const Status ends = CheckEnds(*map, problem);
  if (!ends.ok()) return ends.error();
  const auto baseline = FindBaseline(*map, problem, arguments.baseline);
  if (!baseline.ok()) return baseline.error();
  const auto pool = advisor::LoadReferences(arguments.references);
  if (!pool.ok()) return pool.error();
  const advisor::PlanningCase planning_case{
      arguments.case_id.empty()
          ? advisor::BusCaseId(MapId(*map), problem.start, problem.goal)
          : arguments.case_id,
      *map,
      problem.start,
      problem.goal,
      baseline->route,
      baseline->cost,
      ""};
  const auto begin = std::chrono::steady_clock::now();
  Prepared prepared{
      advisor::PrepareCase(planning_case, arguments.method, pool->get())};
  prepared.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin)
          .count();
  return prepared;
}

Status Write(const advisor::LlmRequest& request, const std::string& out) {
  const std::filesystem::path folder = out;
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) {
    return Error{ErrorCode::kUnavailable,
                 out + ": the folder cannot be made: " + failed.message()};
  }
  int number = 0;
  for (const auto& picture : request.pictures) {
    const std::string name = "image-" + std::to_string(++number) + ".png";
    const Status written =
        WriteWholeFile((folder / name).string(), picture->png);
    if (!written.ok()) return written;
  }
  return WriteWholeFile((folder / "prompt.txt").string(), request.text);
}

int RunPrompt(const PromptArguments& arguments) {
  const Result<Prepared> prepared = Prepare(arguments);
  if (!prepared.ok()) return Fail(prepared.error());
  const advisor::PreparedCase& question = prepared->question;
  const Status written = Write(question.request, arguments.out);
  if (!written.ok()) return Fail(written.error());
  if (question.reference_missing) {
    std::cerr << "terra: no reference pair has this map's legend; the question "
                 "goes without one (--references)\n";
  }
  if (arguments.json) {
    const nlohmann::ordered_json json = {
        {"out", arguments.out},
        {"images", question.request.pictures.size()},
        {"prompt_id", question.request.prompt_id},
        {"reference", question.reference_id},
        {"seconds", prepared->seconds}};
    std::cout << json.dump(-1, ' ', false,
                           nlohmann::ordered_json::error_handler_t::replace)
              << "\n";
  } else {
    const std::size_t images = question.request.pictures.size();
    std::cout << arguments.out
              << Printed(": prompt.txt and %zu image%s, prepared in %.1f ms\n",
                         images, images == 1 ? "" : "s",
                         1e3 * prepared->seconds);
  }
  return kDone;
}

}  // namespace

void AddPromptCommand(CLI::App& app, int& exit_code) {
  CLI::App& command = *app.add_subcommand(
      "prompt", "Write what a language model would be shown and asked");
  const auto arguments = std::make_shared<PromptArguments>();
  AddProblemOptions(command, arguments->problem);
  AddBaselineOptions(command, arguments->baseline);
  command.add_option("--out", arguments->out, "Folder to write")
      ->required()
      ->type_name("DIR");
  command.add_option("--case-id", arguments->case_id,
                     "Name of the case, which chooses reference pair and noise "
                     "(default: as on the bus)");
  command.add_flag("--json", arguments->json, "Print JSON");
  advisor::AddExperimentOptions(command, arguments->method);
  advisor::AddPromptOptions(command, arguments->method, arguments->references);
  command.footer(
      "Example:\n"
      "  terra prompt --map park.png --start 20,20 --goal 480,460 --picture "
      "axes --out question");
  command.callback([arguments, &exit_code] {
    exit_code = RunPrompt(*arguments);
  });
}

}  // namespace terra::cli
