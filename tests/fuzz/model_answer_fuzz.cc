// A model server's reply, all the way to the bytes of ADVICE. The first byte
// chooses the provider's form, the status and the method.

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "advisor/provider_client.h"
#include "tests/fuzz/advice_bytes.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace terra::advisor;

constexpr const char* kKey = "sk-fuzz-0123456789";

/// Brings the input instead of a server's reply.
class Replying : public HttpSender {
 public:
  Replying(int status, std::string_view body) {
    reply_.status = status;
    reply_.body = body;
  }

  HttpReply Post(const HttpRequest&, std::stop_token) override {
    return reply_;
  }

 private:
  HttpReply reply_;
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static terra::fuzz::AdviceProblem problem;
  constexpr std::array<const char*, 4> kProviders = {"openai", "gemini",
                                                     "anthropic", "chat"};
  constexpr std::array<int, 4> kStatuses = {200, 200, 200, 429};
  constexpr std::array<Method, 4> kMethods = {
      Method::kAdvisor, Method::kAdvisor, Method::kDirect, Method::kLlmAstar};
  const unsigned choice = data[0];
  ProviderOptions options;
  options.retry.max_retries = 0;
  options.base_url = "http://127.0.0.1:1";
  MethodOptions method;
  method.method = kMethods.at(choice >> 4 & 3);
  method.prompt.candidates = 3;
  const std::string provider = kProviders.at(choice & 3);
  problem.Ask(
      std::make_unique<ProviderClient>(
          MakeWireFormat(provider), options,
          LlmIdentity{provider, "model", "{}", "loopback"}, kKey,
          std::make_unique<Replying>(kStatuses.at(choice >> 2 & 3),
                                     terra::fuzz::Text(data + 1, size - 1))),
      method);
  return 0;
}
