#pragma once

#include "benchmark/loaded_run.h"

namespace terra::benchmark {

/// The metrics of a run, all groups together.
inline Metrics MetricsOfAll(const LoadedRun& run) {
  MetricsBuilder builder(run.description.rule);
  const Status read = run.read([&](const Score& score) {
    builder.Add(score);
  });
  return read.ok() ? builder.Finish() : Metrics();
}

}  // namespace terra::benchmark
