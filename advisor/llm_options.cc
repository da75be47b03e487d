#include "advisor/llm_options.h"

#include <string>

#include <CLI/CLI.hpp>

#include "bus/number_range.h"

namespace terra::advisor {
namespace {

void AddLimitOptions(CLI::App& app, CallLimits& limits) {
  const std::string group = "Limits";
  app.add_option("--calls-per-minute", limits.calls_per_minute,
                 "At most so many calls a minute; 0 = no limit")
      ->capture_default_str()
      ->check(CLI::Range(0, 100'000))
      ->group(group);
  app.add_option("--spend-per-hour", limits.spend_per_hour_usd,
                 "At most so many dollars an hour; needs --price; 0 = no limit")
      ->capture_default_str()
      ->check(bus::InRange(0.0, 1e9))
      ->group(group);
  app.add_option("--breaker-failures", limits.breaker_failures,
                 "Failures in succession after which calls pause; 0 = never")
      ->capture_default_str()
      ->check(CLI::Range(0, 1'000))
      ->group(group);
  app.add_option("--breaker-wait", limits.breaker_first_wait_s,
                 "Seconds of the first such pause; it doubles up to "
                 "--breaker-max-wait")
      ->capture_default_str()
      ->check(bus::InRange(0.1, 86'400.0))
      ->group(group);
  app.add_option("--breaker-max-wait", limits.breaker_max_wait_s,
                 "Seconds of the longest pause")
      ->capture_default_str()
      ->check(bus::InRange(0.1, 86'400.0))
      ->group(group);
}

void AddProviderOptions(CLI::App& app, ProviderOptions& provider) {
  const std::string group = "Model";
  GenerationSettings& settings = provider.settings;
  AddSettingsOptions(app, settings);
  app.add_option("--base-url", provider.base_url,
                 "Address of a server that speaks the backend's form; https, "
                 "or http on this machine")
      ->group(group);
  app.add_flag("--real-model", provider.real_model,
               "The server on this machine runs a real model: do not mark "
               "results SIMULATED")
      ->group(group);
  app.add_option("--anthropic-version", settings.anthropic_version,
                 "anthropic: version header")
      ->capture_default_str()
      ->group(group);
  app.add_flag("--anthropic-bearer", settings.anthropic_bearer,
               "anthropic: send the key as bearer token")
      ->group(group);
  app.add_option("--try-timeout", provider.try_timeout_s,
                 "Seconds for one request")
      ->capture_default_str()
      ->check(bus::InRange(0.1, 3'600.0))
      ->group(group);
  app.add_option("--deadline", provider.deadline_s,
                 "Seconds for a case, retries and waits included")
      ->capture_default_str()
      ->check(bus::InRange(0.1, 604'800.0))
      ->group(group);
  app.add_option("--retries", provider.retry.max_retries,
                 "Requests after the first one, for passing failures")
      ->capture_default_str()
      ->check(CLI::Range(0, 10))
      ->group(group);
  app.add_option("--max-retry-wait", provider.retry.max_wait_s,
                 "Seconds; a server that demands a longer wait has failed")
      ->capture_default_str()
      ->check(bus::InRange(0.0, 3'600.0))
      ->group(group);
}

}  // namespace

void AddSettingsOptions(CLI::App& app, GenerationSettings& settings) {
  const std::string group = "Model";
  app.add_option("--model", settings.model,
                 "Model; empty = the backend's default")
      ->group(group);
  app.add_option("--max-output-tokens", settings.max_output_tokens,
                 "Token limit of an answer, thinking included")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000))
      ->group(group);
  app.add_option("--effort", settings.effort,
                 "Thinking effort; '' = leave it to the provider")
      ->capture_default_str()
      ->group(group);
  app.add_option("--image-detail", settings.image_detail,
                 "openai: image detail; '' = not sent")
      ->capture_default_str()
      ->group(group);
}

void AddPromptOptions(CLI::App& app, MethodOptions& method,
                      std::string& references) {
  const std::string group = "Prompt";
  PromptSwitches& prompt = method.prompt;
  app.add_option_function<std::string>(
         "--method",
         [&method](const std::string& name) {
           method.method = FindMethod(name).value();
         },
         "advisor, direct or llm-astar")
      ->check(CLI::IsMember({"advisor", "direct", "llm-astar"}))
      ->default_str("advisor")
      ->group(group);
  app.add_option_function<std::string>(
         "--picture",
         [&prompt](const std::string& form) {
           prompt.axes = form == "axes";
         },
         "native (one pixel a cell) or axes (two, with ticks and grid lines)")
      ->check(CLI::IsMember({"native", "axes"}))
      ->default_str("native")
      ->group(group);
  app.add_flag("--regions", prompt.regions, "Terrain as a table of regions")
      ->group(group);
  app.add_flag("--stretches", prompt.stretches,
               "Cost of the baseline by stretch of terrain")
      ->group(group);
  app.add_option("--candidates", prompt.candidates,
                 "Routes asked for in one answer")
      ->capture_default_str()
      ->check(CLI::Range(1, 8))
      ->group(group);
  app.add_option("--references", references,
                 "Pool of reference pairs (default: the one that comes along)")
      ->type_name("F.jsonl")
      ->group(group);
  app.add_option("--seed", method.seed,
                 "Of the choice of references, and of noise")
      ->capture_default_str()
      ->group(group);
}

void AddExperimentOptions(CLI::App& app, MethodOptions& method) {
  const std::string group = "Experiments";
  PromptSwitches& prompt = method.prompt;
  app.add_flag("--overlay,!--no-overlay", prompt.overlay,
               "Show the picture with the baseline (default)")
      ->default_str("true")
      ->group(group);
  app.add_flag("--route-text,!--no-route-text", prompt.route_text,
               "Describe the baseline's points and cost (default)")
      ->default_str("true")
      ->group(group);
  app.add_flag("--rea,!--no-rea", prompt.rea, "Show a reference pair (default)")
      ->default_str("true")
      ->group(group);
  app.add_option("--noise", method.noise_percent,
                 "Percent of the cells that the model is shown wrongly")
      ->capture_default_str()
      ->check(bus::InRange(0.0, 100.0))
      ->group(group);
}

void AddLlmOptions(CLI::App& app, LlmBackendOptions& options) {
  LlmServiceOptions& service = options.service;
  AddPromptOptions(app, options.method, options.references);
  AddProviderOptions(app, service.provider);
  AddLimitOptions(app, service.limits);
  app.add_option(
         "--rounds", options.method.rounds,
         "Times that a case may be asked: a rejected proposal goes back "
         "with its verdict, while --deadline allows")
      ->capture_default_str()
      ->check(CLI::Range(1, 10))
      ->group("Prompt");
  app.add_option("--min-gain", options.min_gain_percent,
                 "Do not ask where the native optimum is not this many percent "
                 "cheaper than the baseline; 0 = always ask")
      ->capture_default_str()
      ->check(bus::InRange(0.0, 100.0))
      ->group("Limits");
  const std::string group = "Model";
  app.add_option("--exchange", service.exchange_folder,
                 "exchange: folder of questions and answers")
      ->capture_default_str()
      ->group(group);
  app.add_option("--recording", service.recording,
                 "replay: recording to answer from")
      ->group(group);
  app.add_option("--record", service.record,
                 "Keep every call in this file (JSON lines)")
      ->group(group);
  app.add_flag("--images,!--no-images", service.record_images,
               "Keep the pictures beside a recording (default)")
      ->default_str("true")
      ->group(group);
  app.add_option("--price", service.prices,
                 "MODEL=INPUT:OUTPUT, dollars per million tokens; repeatable")
      ->default_str("")
      ->group(group);
}

}  // namespace terra::advisor
