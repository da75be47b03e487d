#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/speed/speed_case.h"
#include "benchmark/speed/timing.h"

namespace terra::benchmark {

/// Where speed measurements are kept, in small files that are there completely
/// or not at all, so that a run can be broken off and taken up again:
///   samples/SIDE-FAMILY-INDEX.csv   one time a line, of all works on a case
///   maps/SIDE-FAMILY-INDEX.f32      costs as float32, row by row, inf =
///   blocked maps/SIDE-FAMILY-INDEX.csv      its ends; written after the .f32
/// Errors: std::runtime_error where a file cannot be written.
class SpeedFolder {
 public:
  explicit SpeedFolder(std::filesystem::path folder);

  /// Whether the samples of a case are there.
  bool Has(int side, const std::string& family, int index) const;
  /// For peers in other languages (skimage_peer.py).
  void WriteMap(const SpeedCase& c) const;
  void WriteSamples(const SpeedCase& c,
                    const std::vector<TimedSample>& samples) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace terra::benchmark
