#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "advisor/llm_backend.h"
#include "benchmark/run.h"
#include "terrain/files/dataset.h"
#include "terrain/result.h"

// A whole evaluation at batch price: its questions go to a provider in files,
// the answers come back in files, and become a recording to replay.
namespace terra::benchmark {

/// The file in a batch's folder with its requests, each a record without an
/// answer.
inline constexpr const char* kOpenRequestsName = "open.jsonl";

/// Where a batch is written, and what of it.
struct BatchFolder {
  std::string path;
  /// Requests that this recording has an answer to are left out: what failed
  /// or expired in an earlier batch is asked again. Empty = all.
  std::string except;
  bool images = true;  ///< Keep the pictures beside, by hash, as recordings do.
};

struct ExportedBatch {
  std::int64_t requests = 0;
  std::int64_t left_out = 0;
  std::int64_t without_baseline = 0;
  std::vector<std::string> files;  ///< To be sent to the provider.
};

/// Writes the questions of a dataset's cases and repeats, in the form of the
/// provider that `llm.service.backend` names, into as many files as its limits
/// demand: requests-001.jsonl, ...; and open.jsonl, a recording whose answers
/// are missing, for ImportBatch.
///
/// Errors: a provider without batches; a map that cannot be read; a folder that
/// holds a batch already or cannot be written.
Result<ExportedBatch> ExportBatch(const DatasetFolder& dataset,
                                  const RunOptions& options,
                                  const advisor::LlmBackendOptions& llm,
                                  const BatchFolder& folder);

/// What became of a batch's requests.
struct ImportedBatch {
  std::int64_t imported = 0;
  std::int64_t known = 0;    ///< The recording had an answer before.
  std::int64_t missing = 0;  ///< No result file speaks of them.
  std::int64_t failed = 0;   ///< Errored, expired, cancelled.
  std::int64_t foreign = 0;  ///< Results that this batch did not ask for.
  std::int64_t doubled = 0;  ///< Further results for one request: not used.
  std::vector<std::string> failures;  ///< "CASE_ID: why", in the batch's order.
};

/// Adds the answers in a provider's result files (any order, any number) to a
/// recording, in the order of the batch. Requests without an answer are not
/// kept, so a run says of them that they have none. Doing it again changes
/// nothing. `prices` are those of the batch.
///
/// Errors: not a batch's folder; a line that is no result (nothing is written
/// then); the recording cannot be written.
Result<ImportedBatch> ImportBatch(const std::string& folder,
                                  const std::vector<std::string>& result_files,
                                  const std::string& recording,
                                  const advisor::PriceTable& prices);

}  // namespace terra::benchmark
