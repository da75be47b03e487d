#include <chrono>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "advisor/advisor_options.h"
#include "base/secrets.h"
#include "cli/baseline.h"
#include "cli/commands.h"
#include "cli/map_arguments.h"
#include "cli/output.h"
#include "terrain/digest.h"
#include "terrain/files/csv.h"
#include "terrain/route_text.h"
#include "verifier/verify.h"

namespace terra::cli {
namespace {

using advisor::AdviceAnswer;
using advisor::AnswerKind;
using verifier::Code;

struct AdviseArguments {
  ProblemArguments problem;
  advisor::AdvisorOptions advisor;
  BaselineArguments baseline;
  bool json = false;
};

// One run of an advisor and what the gate would make of it.
struct Advised {
  Route baseline;
  double baseline_cost = kImpassable;
  Code code = Code::kNotChecked;
  AdviceAnswer answer;
  Route candidate;  // Empty when the advisor proposed none.
  double candidate_cost = kImpassable;
  double seconds = 0;  // Of the advisor alone.
};

// The cheapest candidate that the gate would accept, else the first one.
void JudgeCandidates(const AdviceAnswer& answer, const TerrainMap& map,
                     const ProblemArguments& problem, Advised& advised) {
  for (const advisor::Candidate& candidate : answer.candidates) {
    const verifier::Comparison result = verifier::CompareRoutes(
        map, problem.start, problem.goal, advised.baseline, candidate.route);
    const bool better =
        result.accepted() && result.candidate.cost < advised.candidate_cost;
    if (advised.code != Code::kNotChecked && !better) continue;
    advised.code = result.code;
    advised.candidate = candidate.route;
    advised.candidate_cost = result.candidate.cost;
  }
}

Result<Advised> Advise(const AdviseArguments& arguments,
                       const TerrainMap& map) {
  const ProblemArguments& problem = arguments.problem;
  Advised advised;
  Result<Baseline> baseline = FindBaseline(map, problem, arguments.baseline);
  if (!baseline.ok()) return baseline.error();
  advised.baseline = std::move(baseline->route);
  advised.baseline_cost = baseline->cost;

  const auto backend = advisor::MakeBackend(arguments.advisor);
  if (!backend) return backend.error();
  ForgetApiKeys();
  if (arguments.advisor.backend == "exchange") {
    std::cerr << "terra: the question goes to a folder in "
              << arguments.advisor.llm.service.exchange_folder
              << " (README.txt there); waiting for its answer.txt\n";
  }
  const auto begin = std::chrono::steady_clock::now();
  advised.answer =
      (*backend)->Advise({map, MapId(map), 0, problem.start, problem.goal,
                          advised.baseline, advised.baseline_cost},
                         {});
  advised.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin)
          .count();
  switch (advised.answer.kind) {
    case AnswerKind::kRetain:
      advised.code = Code::kRetained;
      break;
    case AnswerKind::kPropose:
      JudgeCandidates(advised.answer, map, problem, advised);
      break;
    case AnswerKind::kMalformed:
      advised.code = Code::kParseError;
      break;
    case AnswerKind::kFailed:
      return Error{ErrorCode::kUnavailable,
                   "the advisor gave no answer: " + advised.answer.error};
  }
  return advised;
}

const char* DeployedRoute(const Advised& advised) {
  return advised.code == Code::kAccepted ? "candidate" : "baseline";
}

void PrintJson(const Advised& advised) {
  const nlohmann::ordered_json json = {
      {"code", verifier::CodeName(advised.code)},
      {"candidate_cost", JsonCost(advised.candidate_cost)},
      {"baseline_cost", JsonCost(advised.baseline_cost)},
      {"deployed", DeployedRoute(advised)},
      {"waypoints", JsonRoute(advised.candidate)},
      {"baseline", JsonRoute(advised.baseline)},
      {"model", advised.answer.model},
      {"simulated", advised.answer.simulated},
      {"tokens_in", advised.answer.tokens_in},
      {"tokens_out", advised.answer.tokens_out},
      {"spend_usd", advised.answer.spend_usd},
      {"answer", advised.answer.answer_text},
      {"error", advised.answer.error},
      {"seconds", advised.seconds}};
  std::cout << json.dump(-1, ' ', false,
                         nlohmann::ordered_json::error_handler_t::replace)
            << "\n";
}

// On one line, without what could steer a terminal.
std::string Shown(const std::string& text) {
  constexpr std::size_t kMost = 400;
  const bool cut = text.size() > kMost;
  return nlohmann::json(text.substr(0, kMost))
             .dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) +
         (cut ? " ..." : "");
}

// What a model said, where there is one.
void PrintAnswer(const AdviceAnswer& answer) {
  if (answer.simulated) {
    std::cout << "SIMULATED  by a program on this machine; --real-model says "
                 "that it runs a model\n";
  }
  if (!answer.model.empty()) {
    std::cout << "model      " << answer.model << ", " << answer.tokens_in
              << " tokens in, " << answer.tokens_out << " out"
              << (answer.spend_usd > 0 ? Printed(", $%.4f", answer.spend_usd)
                                       : "")
              << "\n"
              << "answer     " << Shown(answer.answer_text) << "\n";
  }
  if (!answer.error.empty()) std::cout << "reason     " << answer.error << "\n";
}

void PrintText(const Advised& advised) {
  PrintAnswer(advised.answer);
  std::cout << "verdict    " << verifier::CodeName(advised.code) << "\n"
            << "deployed   " << DeployedRoute(advised) << "\n"
            << "baseline   cost " << FormatNumber(advised.baseline_cost) << ", "
            << FormatRoute(advised.baseline) << "\n";
  if (!advised.candidate.empty()) {
    std::cout << "candidate  cost " << FormatNumber(advised.candidate_cost)
              << ", " << FormatRoute(advised.candidate) << "\n";
  }
  std::cout << "seconds    " << advised.seconds << "\n";
}

int RunAdvise(const AdviseArguments& arguments) {
  const ProblemArguments& problem = arguments.problem;
  const Result<TerrainMap> map = LoadMap(problem.map);
  if (!map.ok()) return Fail(map.error());
  const Status ends = CheckEnds(*map, problem);
  if (!ends.ok()) return Fail(ends.error());
  const Result<Advised> advised = Advise(arguments, *map);
  if (!advised.ok()) return Fail(advised.error());
  if (arguments.json) {
    PrintJson(*advised);
  } else {
    PrintText(*advised);
  }
  return kDone;
}

}  // namespace

void AddAdviseCommand(CLI::App& app, int& exit_code) {
  CLI::App& command = *app.add_subcommand(
      "advise", "Run one advisor on one case, without the bus");
  const auto arguments = std::make_shared<AdviseArguments>();
  AddProblemOptions(command, arguments->problem);
  AddBaselineOptions(command, arguments->baseline);
  command.add_flag("--json", arguments->json, "Print JSON");
  advisor::AddAdvisorOptions(command, arguments->advisor);
  command.footer(
      "Example:\n"
      "  terra advise --map park.png --start 20,20 --goal 480,460 --backend "
      "shortcut");
  command.callback([arguments, &exit_code] {
    exit_code = RunAdvise(*arguments);
  });
}

}  // namespace terra::cli
