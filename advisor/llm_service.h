#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "advisor/call_limits.h"
#include "advisor/limited_client.h"
#include "advisor/llm_client.h"
#include "advisor/provider_client.h"
#include "terrain/result.h"

namespace terra::advisor {

/// Everything that says which model answers, and within which limits.
struct LlmServiceOptions {
  std::string backend;  ///< One of kLlmBackendNames.
  ProviderOptions provider;
  std::string exchange_folder = "exchange";
  std::string recording;  ///< replay: what is replayed.
  std::string record;     ///< Where calls are kept; empty = nowhere.
  bool record_images = true;
  CallLimits limits;
  std::vector<std::string> prices;  ///< "MODEL=INPUT:OUTPUT".
};

/// The backends of a model, or of whoever stands in for one.
inline constexpr std::array<std::string_view, 6> kLlmBackendNames = {
    "openai", "gemini", "anthropic", "chat", "exchange", "replay"};

/// A client ready to be asked, with its figures.
struct LlmService {
  std::unique_ptr<LlmClient> client;
  std::shared_ptr<CallMonitor> monitor;
};

/// Puts the client together: backend, then limits and prices, then recording.
/// Errors: as of the parts; a spend limit without a price of the model.
Result<LlmService> MakeLlmService(const LlmServiceOptions& options,
                                  AtLimit at_limit);

}  // namespace terra::advisor
