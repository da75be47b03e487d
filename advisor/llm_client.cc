#include "advisor/llm_client.h"

#include <array>

#include "advisor/fingerprint.h"

namespace terra::advisor {

std::string_view NoAnswerName(NoAnswer reason) {
  constexpr std::array<std::string_view, 11> kNames = {
      "none",        "transport",    "http_status", "bad_reply",
      "too_large",   "deadline",     "cancelled",   "rate_limit",
      "spend_limit", "breaker_open", "not_recorded"};
  return kNames.at(static_cast<std::size_t>(reason));
}

std::string RequestHash(const LlmIdentity& identity,
                        const LlmRequest& request) {
  Fingerprint hash;
  hash.Add(request.method);
  hash.Add(identity.model);
  hash.Add(identity.settings);
  hash.Add(request.text);
  hash.Add(static_cast<std::int64_t>(request.pictures.size()));
  for (const auto& picture : request.pictures) {
    hash.Add(picture->pixel_hash);
  }
  return hash.Hex();
}

}  // namespace terra::advisor
