// That random sequences reach what the properties are meant to test.
#include "tests/verifier/gate_trace.h"

#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/random_map.h"

namespace terra::verifier {
namespace {

TEST(GateTraceTest, SequencesReachEveryModeCauseAndCode) {
  std::map<std::string, int> seen;
  testing::Random bits(1);
  for (int i = 0; i < 3'000; ++i) {
    std::vector<std::uint32_t> random;
    for (int k = 0; k < 50; ++k) {
      random.push_back(static_cast<std::uint32_t>(bits.Int(0, 2'000'000'000)));
    }
    for (const Turn& turn : PlayTrace(random)) {
      for (const Decision& decision : turn.decisions) {
        if (const auto* verdict = std::get_if<Verdict>(&decision)) {
          ++seen[std::string(CodeName(verdict->code)) +
                 (verdict->subject == Subject::kBaseline ? " baseline" : "")];
          if (verdict->code == Code::kAccepted && verdict->anchor.index > 0) {
            ++seen["accepted ahead"];
          }
        } else {
          const auto& deployed = std::get<Deployed>(decision);
          ++seen["mode " + std::to_string(static_cast<int>(deployed.mode))];
          ++seen["cause " + std::to_string(static_cast<int>(deployed.cause))];
        }
      }
    }
  }
  for (const auto& [what, times] : seen) {
    RecordProperty(what, times);
  }
  for (int mode = 0; mode <= 3; ++mode) {
    EXPECT_GE(seen["mode " + std::to_string(mode)], 10) << mode;
  }
  for (int cause = 1; cause <= 9; ++cause) {
    EXPECT_GE(seen["cause " + std::to_string(cause)], 10) << cause;
  }
  for (const char* code : {"accepted",          "accepted ahead",
                           "retained",          "parse_error",
                           "too_few_waypoints", "start_mismatch",
                           "goal_mismatch",     "out_of_bounds",
                           "obstacle",          "work_limit",
                           "not_cheaper",       "not_best",
                           "stale_request",     "stale_map",
                           "stale_baseline",    "baseline_invalid",
                           "malformed_message", "late",
                           "obstacle baseline", "malformed_message baseline"}) {
    EXPECT_GE(seen[code], 10) << code;
  }
}

}  // namespace
}  // namespace terra::verifier
