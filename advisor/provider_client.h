#pragma once

#include <memory>
#include <string>

#include "advisor/http_transport.h"
#include "advisor/llm_client.h"
#include "advisor/retry_policy.h"
#include "advisor/wire_format.h"
#include "terrain/result.h"

namespace terra::advisor {

/// How a provider is called.
struct ProviderOptions {
  GenerationSettings settings;
  std::string base_url;  ///< Empty = the provider's own.
  /// What answers on this machine is a real model, not something that plays
  /// one.
  bool real_model = false;
  double try_timeout_s = 600;  ///< Of one request.
  double deadline_s = 900;     ///< Of a call, retries and waits included.
  RetryLimits retry;
};

/// Asks a provider (or a server that speaks its form) over HTTP.
/// Threads: as LlmClient.
class ProviderClient : public LlmClient {
 public:
  /// Takes the key from the environment variable that the format names; the
  /// process then leaves no core file. Errors: an unknown provider, an address
  /// that is not allowed, a missing key.
  static Result<std::unique_ptr<LlmClient>> Create(
      const std::string& provider, const ProviderOptions& options);

  ProviderClient(
      std::unique_ptr<WireFormat> format, ProviderOptions options,
      LlmIdentity identity, std::string key,
      std::unique_ptr<HttpSender> http = std::make_unique<HttpTransport>());

  const LlmIdentity& identity() const override { return identity_; }
  LlmReply Ask(const LlmRequest& request, std::stop_token stop) override;

 private:
  /// One request: what it brought goes into `reply`, the rest is returned.
  TryOutcome Try(const HttpRequest& request, LlmReply& reply,
                 std::stop_token stop);
  std::string KeyAdvice() const;
  std::string WithoutKey(std::string text) const;
  std::string BodyWithoutKey(std::string body) const;

  std::unique_ptr<WireFormat> format_;
  ProviderOptions options_;
  LlmIdentity identity_;
  std::string key_;
  std::unique_ptr<HttpSender> http_;
};

}  // namespace terra::advisor
