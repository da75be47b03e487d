// The memory of `terra bench` does not grow with the cases of a dataset.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "terrain/files/legend_file.h"
#include "terrain/files/map_file.h"
#include "tests/support/ascii_map.h"
#include "tests/support/child_process.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

using terra::testing::ProgramPath;
using terra::testing::RunResult;
using terra::testing::RunToEnd;
using terra::testing::TempFolder;

// Sanitizers keep what is freed, and shadows of it: their figures say nothing.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
#else
constexpr bool kSanitized = false;
#endif

constexpr int kFewCases = 3'000;
constexpr int kManyCases = 20 * kFewCases;
// An id and a path are more than this; what is kept of a case is 8 bytes of an
// id's hash and a bit.
constexpr long kBytesPerCase = 64;
constexpr long kMaxGrowthKilobytes = kManyCases * kBytesPerCase / 1024;

class BenchMemory : public ::testing::Test {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "memory of a sanitizer build is its own";
  }

  // A dataset with this many cases on one tiny map.
  std::string Dataset(const std::string& name, int cases) {
    const TerrainMap map = testing::MapFromAscii({"111", "191", "111"});
    std::string text = "case_id,map,start_x,start_y,goal_x,goal_y,group\n";
    for (int i = 0; i < cases; ++i) {
      text += "case_" + std::to_string(i) + ",map.png,0,0,2,2,easy\n";
    }
    folder_.Write(name + "/cases.csv", text);
    EXPECT_TRUE(
        WriteLegend(map.legend(), folder_.Path(name + "/legend.csv")).ok());
    EXPECT_TRUE(WriteIdPng(map, folder_.Path(name + "/map.png")).ok());
    return folder_.Path(name);
  }

  // Peak resident kB.
  static long PeakOf(const std::vector<std::string>& command) {
    const RunResult run = RunToEnd(command);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return run.peak_kilobytes;
  }

  const std::string terra_ = ProgramPath("terra");
  TempFolder folder_;
};

TEST_F(BenchMemory, OfARunDoesNotGrowWithTheCases) {
  const auto peak = [&](const std::string& name, int cases) {
    const std::vector<std::string> run = {terra_,
                                          "bench",
                                          "run",
                                          "--dataset",
                                          Dataset(name, cases),
                                          "--method",
                                          "coarse",
                                          "--stride",
                                          "2",
                                          "--jobs",
                                          "1",
                                          "--out",
                                          folder_.Path(name + ".run")};
    const long fresh = PeakOf(run);
    return std::max(fresh, PeakOf(run));  // The second finds all done.
  };
  EXPECT_LT(peak("many", kManyCases) - peak("few", kFewCases),
            kMaxGrowthKilobytes);
}

TEST_F(BenchMemory, OfGapsDoesNotGrowWithTheCases) {
  const auto peak = [&](const std::string& name, int cases) {
    return PeakOf({terra_, "bench", "gap", "--dataset", Dataset(name, cases),
                   "--strides", "1,2", "--jobs", "1", "--out",
                   folder_.Path(name + ".csv")});
  };
  EXPECT_LT(peak("many", kManyCases) - peak("few", kFewCases),
            kMaxGrowthKilobytes);
}

}  // namespace
}  // namespace terra::benchmark
