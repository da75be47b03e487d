#include "advisor/llm_service.h"

#include <utility>

#include "advisor/exchange_client.h"
#include "advisor/recording_clients.h"

namespace terra::advisor {
namespace {

Result<std::unique_ptr<LlmClient>> MakeClient(const LlmServiceOptions& options,
                                              AtLimit at_limit) {
  if (options.backend == "replay") {
    return ReplayClient::Create(
        options.recording, options.provider.settings.model,
        at_limit == AtLimit::kRefuse ? ReplayFile::kWatched
                                     : ReplayFile::kOnce);
  }
  if (options.backend == "exchange") {
    ExchangeOptions exchange;
    exchange.folder = options.exchange_folder;
    exchange.deadline_s = options.provider.deadline_s;
    if (!options.provider.settings.model.empty()) {
      exchange.model = options.provider.settings.model;
    }
    return std::unique_ptr<LlmClient>(
        std::make_unique<ExchangeClient>(std::move(exchange)));
  }
  return ProviderClient::Create(options.backend, options.provider);
}

}  // namespace

Result<LlmService> MakeLlmService(const LlmServiceOptions& options,
                                  AtLimit at_limit) {
  PriceTable prices;
  for (const std::string& price : options.prices) {
    if (price.empty()) continue;  // So --print-config writes "no price".
    if (const auto added = prices.Add(price); !added) return added.error();
  }
  auto client = MakeClient(options, at_limit);
  if (!client) return client.error();
  const std::string model = (*client)->identity().model;
  if (options.limits.spend_per_hour_usd > 0 && !prices.Knows(model)) {
    return Error{ErrorCode::kInvalid,
                 "--spend-per-hour needs the price of the model: --price " +
                     model + "=INPUT:OUTPUT"};
  }
  LlmService made;
  made.monitor = std::make_shared<CallMonitor>();
  made.client = std::make_unique<LimitedClient>(
      std::move(client.value()), options.limits, std::move(prices), at_limit,
      made.monitor);
  if (!options.record.empty()) {
    auto recording = RecordingClient::Create(
        std::move(made.client), options.record, options.record_images);
    if (!recording) return recording.error();
    made.client = std::move(recording.value());
  }
  return made;
}

}  // namespace terra::advisor
