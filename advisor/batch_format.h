#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "advisor/llm_client.h"
#include "advisor/wire_format.h"
#include "terrain/result.h"

namespace terra::advisor {

/// How a provider takes many requests in one file, for later and for less. The
/// file is head, items with the separator between them, tail.
/// Source: the providers' SDKs; golden batches in the tests.
struct BatchForm {
  std::string_view provider;
  std::string_view extension;
  std::string_view head;
  std::string_view separator;
  std::string_view tail;
  std::size_t max_requests;  ///< Of one file, ...
  std::size_t max_bytes;     ///< ... as the provider documents it.
};

/// "openai", "anthropic", "gemini"; null for any other.
const BatchForm* FindBatchForm(std::string_view provider);

/// What a request is called in a batch: its hash and repeat. Letters, digits
/// and '-', at most 64, which all three accept.
std::string BatchId(const std::string& request_hash, int repeat);

/// A request as an item of its provider's batch file, in one line.
std::string BatchItem(const WireFormat& format, const std::string& id,
                      const LlmRequest& request,
                      const GenerationSettings& settings);

/// What a batch brought for one request.
struct BatchResult {
  std::string id;
  /// As from a call, but untimed. Where nothing came, `error` says why:
  /// "expired", "canceled", or the provider's message.
  LlmReply reply;
};

/// Reads a line of a results file (or of OpenAI's error file). Any bytes may
/// come. Errors: no JSON, or no line of such a file.
Result<BatchResult> ReadBatchResult(const WireFormat& format,
                                    std::string_view line);

}  // namespace terra::advisor
