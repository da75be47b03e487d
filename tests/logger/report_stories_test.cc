// What the report says of each request.
#include "logger/report_stories.h"

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "logger/log_reader.h"
#include "logger/recorder.h"
#include "logger/report_latencies.h"
#include "tests/logger/recorded_run.h"

namespace terra::logger {
namespace {

constexpr std::int64_t kAskedBefore = 21;
constexpr std::int64_t kAskedAfter = 22;

const Route kOver = {
    RecordedRun::kStart, {69, 29}, {90, 29}, RecordedRun::kGoal};

// Records two requests, the second one in a new part, and returns that part.
std::string SecondPart(const testing::TempFolder& folder) {
  RecordedRun run;
  run.Ask(kAskedBefore);
  run.Advise(run.Baseline().value(), kOver);
  const std::size_t first_part = run.messages().size();
  run.Ask(kAskedAfter);
  run.Advise(run.Baseline().value(), kOver);
  RecorderOptions options;
  options.part_bytes = 1;  // whenever it is flushed
  Recorder recorder = Recorder::Start(folder.Path(""), options, 1).value();
  std::int64_t time_us = 0;
  for (const bus::RawMessage& message : run.messages()) {
    recorder.Record({time_us += 1'000,
                     std::string(bus::BaseName(message.channel)),
                     message.bytes});
    if (time_us == 1'000 * static_cast<std::int64_t>(first_part)) {
      EXPECT_TRUE(recorder.Flush(time_us).ok());
    }
  }
  const std::string part = recorder.path();
  EXPECT_TRUE(recorder.Close(time_us).ok());
  return part;
}

TEST(Stories, TimesOfARequestFromBeforeThePartAreUnknown) {
  const testing::TempFolder folder;
  Result<LogReader> reader = LogReader::Open(SecondPart(folder));
  ASSERT_TRUE(reader.ok());
  SealChecker seals;
  const LogContents contents = LogContents::Load(*reader, seals);
  const std::vector<RequestStory> stories = Stories(contents);
  ASSERT_EQ(stories.size(), 2U);
  EXPECT_EQ(stories[0].id, kAskedBefore);
  EXPECT_NE(stories[0].last, nullptr) << "its route is known";
  EXPECT_EQ(stories[0].asked_us, 0);
  EXPECT_EQ(stories[0].baseline_us, 0);
  EXPECT_EQ(stories[0].baseline_deployed_us, 0);
  EXPECT_EQ(stories[0].refined_us, 0);
  EXPECT_EQ(stories[1].id, kAskedAfter);
  EXPECT_GT(stories[1].asked_us, 0);
  EXPECT_GT(stories[1].baseline_deployed_us, stories[1].asked_us);
  EXPECT_GT(stories[1].refined_us, stories[1].baseline_deployed_us);
}

// A DEPLOYED or VERDICT at a place of the log, a millisecond an event.
LogContents::Decided DeployedOf(std::int64_t request_id, std::int8_t mode,
                                double cost) {
  terra_msg::deployed_t deployed{};
  deployed.request_id = request_id;
  deployed.mode = mode;
  deployed.deployed_cost = cost;
  deployed.baseline_cost = 100;
  return deployed;
}
template <typename T>
Logged<T> AtEvent(std::int64_t index, T message) {
  return {index, 1'000 * index, std::move(message)};
}

constexpr std::int8_t kBaseline = terra_msg::deployed_t::MODE_BASELINE;
constexpr std::int8_t kCandidate = terra_msg::deployed_t::MODE_CANDIDATE;

// The sessions of a gate and of its successor are random: each order in turn.
TEST(Stories, AGateThatWasKilledAndItsSuccessorAreInTheOrderOfTheLog) {
  for (const auto& [killed, successor] : {std::pair{1, 2}, {2, 1}}) {
    LogContents contents;
    contents.requests[9] = AtEvent(10, terra_msg::plan_request_t{});
    auto& first = contents.decisions[killed];
    first[1] = AtEvent(11, DeployedOf(9, kBaseline, 100));
    first[2] = AtEvent(15, DeployedOf(9, kCandidate, 80));
    auto& then = contents.decisions[successor];
    then[1] = AtEvent(43'000, DeployedOf(9, kBaseline, 100));
    then[2] = AtEvent(44'000, DeployedOf(9, kCandidate, 70));
    const std::vector<RequestStory> stories = Stories(contents);
    ASSERT_EQ(stories.size(), 1U);
    EXPECT_EQ(stories[0].baseline_deployed_us, 11'000);
    EXPECT_EQ(stories[0].refined_us, 15'000);
    EXPECT_EQ(stories[0].last->deployed_cost, 70);
  }
}

terra_msg::advice_t AdviceThatTook(const std::string& advisor,
                                   std::int64_t t_llm_us) {
  terra_msg::advice_t advice{};
  advice.advisor = advisor;
  advice.baseline_digest = 77;
  advice.t_llm_us = t_llm_us;
  return advice;
}

// Three answers of an honest advisor, each after two seconds, and a liar's.
LogContents WithALiar(const std::string& liar) {
  LogContents contents;
  contents.last_us = 10'000'000;
  contents.baselines[{77, 1}] = AtEvent(100, terra_msg::baseline_t{});
  for (int i = 1; i <= 3; ++i) {
    contents.advice[{.session = 1, .attempt = i}] = {
        AtEvent(2'200 + i, AdviceThatTook("model", 2'000'000))};
    const std::int64_t lie = i == 1 ? std::numeric_limits<std::int64_t>::min()
                                    : std::numeric_limits<std::int64_t>::max();
    contents.advice[{.session = 0, .attempt = i}] = {
        AtEvent(150 + i, AdviceThatTook(liar, lie))};
  }
  return contents;
}

TEST(RunLatencies, ALiarSpoilsNobodysFiguresAndIsNamed) {
  const RunLatencies latencies = LatenciesOf(WithALiar("liar"), {});
  ASSERT_EQ(latencies.claimed.size(), 1U);
  EXPECT_EQ(latencies.claimed[0].name, "T_llm of model");
  EXPECT_EQ(latencies.claimed[0].seconds, std::vector<double>(3, 2.0));
  ASSERT_EQ(latencies.impossible.size(), 1U);
  EXPECT_EQ(latencies.impossible[0].who, "T_llm of liar");
  EXPECT_EQ(latencies.impossible[0].impossible, 3);
  EXPECT_EQ(latencies.impossible[0].all, 3);
  const std::string page = LatencySection(latencies);
  EXPECT_NE(page.find("T_llm of liar: 3 of 3 figures left out"),
            std::string::npos);
  EXPECT_EQ(page.find("e+1"), std::string::npos) << "no figure of the liar's";
}

TEST(RunLatencies, ALiarUnderAnothersNameSpoilsNoMedian) {
  const RunLatencies latencies = LatenciesOf(WithALiar("model"), {});
  ASSERT_EQ(latencies.claimed.size(), 1U);
  EXPECT_EQ(latencies.claimed[0].seconds, std::vector<double>(3, 2.0));
  ASSERT_EQ(latencies.impossible.size(), 1U);
  EXPECT_EQ(latencies.impossible[0].all, 6);
}

TEST(RunLatencies, WhatIsMeasuredStandsApartFromWhatIsSaid) {
  LogContents contents;
  contents.last_us = 100'000'000;
  contents.requests[9] = AtEvent(10, terra_msg::plan_request_t{});
  contents.decisions[1][1] = AtEvent(12, DeployedOf(9, kBaseline, 100));
  terra_msg::verdict_t verdict{};
  verdict.session = 1;
  verdict.t_det_us = std::numeric_limits<std::int64_t>::max();
  contents.decisions[1][2] = AtEvent(13, LogContents::Decided(verdict));
  verdict.t_det_us = 40;
  contents.decisions[1][3] = AtEvent(14, LogContents::Decided(verdict));
  const RunLatencies latencies = LatenciesOf(contents, Stories(contents));
  ASSERT_EQ(latencies.measured.size(), 3U);
  EXPECT_EQ(latencies.measured[0].seconds, std::vector<double>{0.002});
  ASSERT_EQ(latencies.claimed.size(), 1U);
  ASSERT_EQ(latencies.claimed[0].seconds.size(), 1U);
  EXPECT_NEAR(latencies.claimed[0].seconds[0], 40e-6, 1e-12);
  EXPECT_EQ(latencies.impossible.size(), 1U);
}

TEST(RunLatencies, MoreNamesThanRowsAreCounted) {
  LogContents contents = WithALiar("liar");
  for (int i = 0; i < 100; ++i) {
    contents.advice[{.session = 2, .attempt = i}] = {
        AtEvent(3'000 + i, AdviceThatTook("n" + std::to_string(i), 5))};
  }
  const RunLatencies latencies = LatenciesOf(contents, {});
  EXPECT_LE(latencies.claimed.size(), RunLatencies::kMaxClaimants);
  EXPECT_EQ(latencies.claimed[0].name, "T_llm of model");
  EXPECT_EQ(latencies.left_out, 102 - RunLatencies::kMaxClaimants);
}

}  // namespace
}  // namespace terra::logger
