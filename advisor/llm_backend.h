#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "advisor/call_limits.h"
#include "advisor/limited_client.h"
#include "advisor/llm_client.h"
#include "advisor/llm_methods.h"
#include "advisor/provider_client.h"
#include "terrain/result.h"

namespace CLI {
class App;
}

namespace terra::advisor {

/// Everything that says which model answers, and within which limits.
struct LlmBackendOptions {
  /// "openai", "gemini", "anthropic", "chat", "exchange", "replay".
  std::string backend;
  ProviderOptions provider;
  std::string exchange_folder = "exchange";
  std::string recording;  ///< replay: what is replayed.
  std::string record;     ///< Where calls are kept; empty = nowhere.
  bool record_images = true;
  CallLimits limits;
  std::vector<std::string> prices;  ///< "MODEL=INPUT:OUTPUT".
};

/// Is this backend one of a model (or of whoever stands in for one)?
bool IsLlmBackend(std::string_view backend);

/// A client ready to be asked, with its figures.
struct LlmBackend {
  std::unique_ptr<LlmClient> client;
  std::shared_ptr<CallMonitor> monitor;
};

/// Puts the client together: backend, then limits and prices, then recording.
/// Errors: as of the parts; a spend limit without a price of the model.
Result<LlmBackend> MakeLlmBackend(const LlmBackendOptions& options,
                                  AtLimit at_limit);

/// Adds the command-line options of backend and method, with their defaults.
/// Option `--method` is added too; `--backend` is the caller's.
void AddLlmOptions(CLI::App& app, LlmBackendOptions& backend,
                   MethodOptions& method);

/// Adds only what shapes the question: method, switches, noise, seed.
void AddPromptOptions(CLI::App& app, MethodOptions& method);

}  // namespace terra::advisor
