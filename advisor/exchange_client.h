#pragma once

#include <string>

#include "advisor/llm_client.h"

namespace terra::advisor {

/// How files are exchanged with whoever answers.
struct ExchangeOptions {
  std::string folder;
  std::string model = "exchange";  ///< Who answers, as far as one knows.
  double deadline_s = 86'400;
  double poll_s = 0.1;
};

/// Lets a person or program answer from files. Each question gets a folder,
/// CASE-HASH, with prompt.txt and image-1.png, ...; answer.txt in it is the
/// answer. It is read once it is there and has stopped growing (or was renamed
/// into place); one that holds nothing but white space, or is no regular file,
/// is waited for, which is said once on standard error. A question that has its
/// answer already is not asked again. README.txt in the folder says all this to
/// whoever answers.
class ExchangeClient : public LlmClient {
 public:
  explicit ExchangeClient(ExchangeOptions options);

  const LlmIdentity& identity() const override { return identity_; }
  LlmReply Ask(const LlmRequest& request, std::stop_token stop) override;

 private:
  ExchangeOptions options_;
  LlmIdentity identity_;
};

/// The name of a question's folder: safe characters only.
std::string ExchangeName(const LlmIdentity& identity,
                         const LlmRequest& request);

}  // namespace terra::advisor
