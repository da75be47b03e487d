// What the report says of each request.
#include "logger/report_stories.h"

#include <string>

#include <gtest/gtest.h>

#include "logger/log_reader.h"
#include "logger/recorder.h"
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

}  // namespace
}  // namespace terra::logger
