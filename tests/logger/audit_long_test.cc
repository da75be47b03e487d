// The audit of thousands of random runs.
#include <gtest/gtest.h>

#include "tests/logger/recorded_run.h"

namespace terra::logger {
namespace {

TEST(AuditOfManyRuns, EveryDecisionIsMadeAgain) {
  for (std::uint64_t seed = 1; seed <= 5'000; ++seed) {
    const Audit audit = AuditOf(RandomRun(seed));
    EXPECT_TRUE(audit.clean()) << "seed " << seed << ": " << Text(audit);
    EXPECT_GT(audit.deployed, 0);
  }
}

}  // namespace
}  // namespace terra::logger
