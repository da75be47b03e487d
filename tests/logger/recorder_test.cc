#include "logger/recorder.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/map_exchange.h"
#include "bus/messages.h"
#include "logger/log_contents.h"
#include "logger/log_info.h"
#include "terrain/builtin_legends.h"
#include "terrain/digest.h"
#include "tests/support/temp_folder.h"

namespace terra::logger {
namespace {

using bus::Channel;
using ::testing::SizeIs;
using testing::TempFolder;

constexpr std::int64_t kNow = 1'800'000'000'000'000;
constexpr std::int64_t kOldest = 1'577'836'800'000'000;  // 2020-01-01

std::vector<std::string> PartsIn(const TempFolder& folder) {
  std::vector<std::string> parts;
  for (const auto& entry :
       std::filesystem::directory_iterator(folder.Path(""))) {
    parts.push_back(entry.path().string());
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

LogInfo InfoOf(const std::string& path) {
  Result<LogReader> reader = LogReader::Open(path);
  EXPECT_TRUE(reader.ok());
  return Inspect(*reader);
}

template <typename T>
HeardEvent Heard(const T& message) {
  return {kNow, std::string(bus::BaseName(bus::MessageTraits<T>::kChannel)),
          bus::Encode(message)};
}

HeardEvent Filler(std::size_t bytes) {
  return {kNow, "CAMERA", std::vector<std::uint8_t>(bytes, 7)};
}

RecorderOptions SmallParts() {
  RecorderOptions options;
  options.session = 5;
  options.part_bytes = 10'000;
  return options;
}

Recorder StartIn(const TempFolder& folder, const RecorderOptions& options) {
  return Recorder::Start(folder.Path(""), options, kNow).value();
}

// A map that needs several tiles, as messages.
struct MapMessages {
  terra_msg::map_header_t header;
  std::vector<terra_msg::map_tile_t> tiles;
};

MapMessages SomeMap() {
  ByteRaster ids = ByteRaster::Zero(200, 300);
  ids.block(50, 50, 20, 200).setConstant(10);
  const TerrainMap map =
      TerrainMap::Create(ids, MultiTerraPathLegend()).value();
  MapMessages messages;
  messages.header = bus::MakeMapHeader(map);
  messages.header.session = 3;
  messages.header.seq = 1;
  const TileGrid grid{map.width(), map.height()};
  for (int i = 0; i < grid.count(); ++i) {
    const auto tile = ExtractTile(ids, grid, i);
    const auto frame = bus::CompressTile(tile);
    terra_msg::map_tile_t message{};
    message.num_tiles = 1;
    message.tile_index = {i};
    message.tile_digest = {TileDigest(tile)};
    message.tile_size = {static_cast<std::int32_t>(frame.size())};
    message.num_bytes = static_cast<std::int32_t>(frame.size());
    message.tile_data = frame;
    messages.tiles.push_back(message);
  }
  return messages;
}

TEST(Recorder, AClosedRecordingIsIntactAndHoldsEveryEvent) {
  const TempFolder folder;
  Recorder recorder = StartIn(folder, RecorderOptions{});
  for (int i = 0; i < 100; ++i) recorder.Record(Filler(10));
  EXPECT_TRUE(recorder.Close(kNow).ok());
  const LogInfo info = InfoOf(recorder.path());
  EXPECT_TRUE(info.intact());
  EXPECT_TRUE(info.closed);
  EXPECT_EQ(info.channels.at("CAMERA").events, 100);
}

TEST(Recorder, WhatWasFlushedIsThereWhenTheProcessIsGone) {
  const TempFolder folder;
  Recorder recorder = StartIn(folder, RecorderOptions{});
  recorder.Record(Filler(10));
  ASSERT_TRUE(recorder.Flush(kNow).ok());
  recorder.Record(Filler(10));  // not acknowledged
  const LogInfo info = InfoOf(recorder.path());
  EXPECT_TRUE(info.intact());
  EXPECT_FALSE(info.closed);
  EXPECT_EQ(info.channels.at("CAMERA").events, 1);
  EXPECT_EQ(info.unsealed_bytes, 0);
}

TEST(Recorder, EachPartBeginsWithTheStateInForce) {
  const TempFolder folder;
  Recorder recorder = StartIn(folder, SmallParts());
  const MapMessages map = SomeMap();
  recorder.Record(Heard(map.header));
  for (const auto& tile : map.tiles) recorder.Record(Heard(tile));
  terra_msg::config_t config{};
  config.config_name = "verifier";
  config.session = 9;
  recorder.Record(Heard(config));
  terra_msg::plan_request_t request{};
  request.request_id = 77;
  request.action = terra_msg::plan_request_t::ACTION_GO;
  recorder.Record(Heard(request));
  terra_msg::baseline_t baseline{};
  baseline.request_id = 77;
  baseline.status = terra_msg::baseline_t::STATUS_OK;
  baseline.baseline_digest = 4;
  recorder.Record(Heard(baseline));
  terra_msg::advice_t advice{};
  advice.baseline_digest = 4;
  recorder.Record(Heard(advice));
  terra_msg::deployed_t deployed{};
  deployed.decision = 12;
  deployed.session = 9;
  recorder.Record(Heard(deployed));
  recorder.Record(Filler(20'000));
  ASSERT_TRUE(recorder.Flush(kNow).ok());
  ASSERT_TRUE(recorder.Close(kNow).ok());

  const auto parts = PartsIn(folder);
  ASSERT_THAT(parts, SizeIs(2));
  EXPECT_TRUE(InfoOf(parts[0]).closed);
  Result<LogReader> reader = LogReader::Open(parts[1]);
  ASSERT_TRUE(reader.ok());
  SealChecker seals;
  LogContents contents = LogContents::Load(*reader, seals);
  EXPECT_EQ(seals.header()->part, 1);
  EXPECT_NE(contents.maps.Find(map.header.map_id), nullptr);
  EXPECT_TRUE(contents.configs.contains(9));
  EXPECT_TRUE(contents.requests.contains(77));
  EXPECT_NE(contents.FindBaseline(4, 0), nullptr);
  EXPECT_THAT(contents.advice, SizeIs(1));
  EXPECT_TRUE(contents.decisions.at(9).contains(12));
}

TEST(Recorder, ATileThatIsNotWhatTheHeaderListsIsNoState) {
  const TempFolder folder;
  Recorder recorder = StartIn(folder, SmallParts());
  MapMessages map = SomeMap();
  recorder.Record(Heard(map.header));
  // Says it is tile 0, but is another.
  terra_msg::map_tile_t lie = map.tiles[1];
  lie.tile_index = map.tiles[0].tile_index;
  lie.tile_digest = map.tiles[0].tile_digest;
  recorder.Record(Heard(lie));
  for (const auto& tile : map.tiles) recorder.Record(Heard(tile));
  recorder.Record(Filler(20'000));
  ASSERT_TRUE(recorder.Flush(kNow).ok());
  ASSERT_TRUE(recorder.Close(kNow).ok());
  Result<LogReader> reader = LogReader::Open(recorder.path());
  SealChecker seals;
  EXPECT_NE(LogContents::Load(*reader, seals).maps.Find(map.header.map_id),
            nullptr);
}

TEST(Recorder, TheQuotaDeletesTheOldestPartsOnly) {
  const TempFolder folder;
  folder.Write("notes.txt", std::string(100'000, 'x'));
  RecorderOptions old = SmallParts();
  old.session = 1;
  {
    Recorder earlier = Recorder::Start(folder.Path(""), old, kOldest).value();
    earlier.Record(Filler(30'000));
    ASSERT_TRUE(earlier.Close(kOldest).ok());
  }
  RecorderOptions options = SmallParts();
  options.quota_bytes = 50'000;
  Recorder recorder = StartIn(folder, options);
  for (int i = 0; i < 20; ++i) {
    recorder.Record(Filler(11'000));
    ASSERT_TRUE(recorder.Flush(kNow).ok());
  }
  ASSERT_TRUE(recorder.Close(kNow).ok());
  const auto parts = PartsIn(folder);
  EXPECT_EQ(std::filesystem::path(parts[0]).filename(), "notes.txt");
  std::uintmax_t bytes = 0;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    EXPECT_EQ(parts[i].find("2020"), std::string::npos);
    bytes += std::filesystem::file_size(parts[i]);
    EXPECT_TRUE(InfoOf(parts[i]).intact());
  }
  EXPECT_LE(bytes, 50'000U + 12'000U);
  EXPECT_EQ(parts.back(), recorder.path());
  EXPECT_GT(recorder.deleted_parts(), 10);
}

TEST(Recorder, TheQuotaGoesByAgeOfRecordingsAlsoWhenTheClockIsWrong) {
  const TempFolder folder;
  RecorderOptions options = SmallParts();
  const auto record = [&](Recorder recorder) {
    for (int i = 0; i < 3; ++i) {
      recorder.Record(Filler(11'000));
      EXPECT_TRUE(recorder.Flush(0).ok());
    }
    EXPECT_TRUE(recorder.Close(0).ok());
    return recorder;
  };
  const Recorder earlier = record(StartIn(folder, options));
  options.session = 6;
  options.quota_bytes = 60'000;
  // The clock of a machine without a battery begins in 1970.
  const Recorder later =
      record(Recorder::Start(folder.Path(""), options, 0).value());
  EXPECT_GT(later.deleted_parts(), 0);
  const LogFolder logs = LogFolder::Open(folder.Path("")).value();
  int of_later = 0;
  for (const StoredPart& part : logs.Parts()) of_later += part.recording == 2;
  EXPECT_EQ(of_later, later.part() + 1) << "the newest recording is whole";
}

// A part with nothing but its header, as a recording's number `number`.
std::string WritePart(const LogFolder& folder, std::int64_t begin_us,
                      std::int64_t recording, std::int32_t number) {
  const std::string path = folder.PartPath(begin_us, recording, number);
  LogWriter writer =
      LogWriter::Create({path, "TERRA_LOG", recording, number}).value();
  writer.Seal(begin_us, terra_msg::log_mark_t::KIND_HEADER,
              RecordingLine(recording));
  EXPECT_TRUE(writer.Sync().ok());
  return path;
}

TEST(LogFolder, OrdersPartsByRecordingAndNumberNotByName) {
  const TempFolder folder;
  const LogFolder logs = LogFolder::Open(folder.Path("")).value();
  std::vector<std::string> expected;
  for (const int number : {998, 999, 1000, 1001}) {
    expected.push_back(WritePart(logs, kNow, 1, number));
  }
  expected.push_back(WritePart(logs, kOldest, 2, 0));
  std::vector<std::string> paths;
  for (const StoredPart& part : logs.Parts()) paths.push_back(part.path);
  EXPECT_EQ(paths, expected);
  EXPECT_EQ(logs.ShrinkTo(0), 5);
}

TEST(LogFolder, TouchesNoLinkAndNothingThatIsNoRecording) {
  const TempFolder folder;
  const TempFolder elsewhere;
  const LogFolder logs = LogFolder::Open(folder.Path("")).value();
  const LogFolder others = LogFolder::Open(elsewhere.Path("")).value();
  const std::string target = WritePart(others, kNow, 1, 0);
  const std::string link =
      folder.Path("terra-20260131T235959Z-0123abcd.000.lcmlog");
  std::filesystem::create_symlink(target, link);
  const std::string foreign = folder.Write(
      "terra-20260131T235959Z-0123abcd.001.lcmlog", std::string(30'000, 'x'));
  EXPECT_EQ(logs.ShrinkTo(0), 0);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_TRUE(std::filesystem::exists(target));
  EXPECT_TRUE(std::filesystem::exists(foreign));
}

struct Intrusion {
  const char* name;
  std::function<void(const std::string& path)> act;
  const char* said;
  bool loses_events;
};

class RecorderIntruded : public ::testing::TestWithParam<Intrusion> {};

TEST_P(RecorderIntruded, SaysSoAndGoesOnInANewPart) {
  const TempFolder folder;
  Recorder recorder =
      Recorder::Start(folder.Path("log"), RecorderOptions{}, kNow).value();
  for (int i = 0; i < 3; ++i) recorder.Record(Filler(100));
  ASSERT_TRUE(recorder.Flush(kNow).ok());
  const std::string first = recorder.path();
  const std::int64_t acknowledged = recorder.acknowledged_events();
  GetParam().act(first);
  recorder.Record(Filler(100));
  const Status flushed = recorder.Flush(kNow);
  ASSERT_FALSE(flushed.ok());
  EXPECT_EQ(flushed.error().code, ErrorCode::kNotFound);
  EXPECT_NE(flushed.error().message.find(first + GetParam().said),
            std::string::npos)
      << flushed.error().message;
  EXPECT_NE(recorder.path(), first);
  EXPECT_EQ(recorder.lost(), GetParam().loses_events ? acknowledged : 0);
  ASSERT_TRUE(recorder.Close(kNow).ok());
  const LogInfo info = InfoOf(recorder.path());
  EXPECT_TRUE(info.closed);
  EXPECT_EQ(info.channels.at("CAMERA").events, 1) << "what waited is written";
  EXPECT_EQ(info.lost, recorder.lost());
  EXPECT_EQ(recorder.acknowledged_events(),
            info.events + (GetParam().loses_events ? 0 : acknowledged));
}

INSTANTIATE_TEST_SUITE_P(
    Intrusions, RecorderIntruded,
    ::testing::Values(
        Intrusion{"folder deleted",
                  [](const std::string& path) {
                    std::filesystem::remove_all(
                        std::filesystem::path(path).parent_path());
                  },
                  " was deleted", true},
        Intrusion{"file deleted",
                  [](const std::string& path) {
                    std::filesystem::remove(path);
                  },
                  " was deleted", true},
        Intrusion{"cut",
                  [](const std::string& path) {
                    std::filesystem::resize_file(path, 100);
                  },
                  " was cut", true},
        Intrusion{"moved",
                  [](const std::string& path) {
                    std::filesystem::rename(path, path + ".old");
                  },
                  " was moved or replaced", false},
        Intrusion{"written to",
                  [](const std::string& path) {
                    std::ofstream(path, std::ios::app) << "garbage";
                  },
                  " was written to", false}),
    [](const ::testing::TestParamInfo<Intrusion>& way) {
      std::string name = way.param.name;
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });

TEST(Recorder, AFileTakenAwayWhileTheFolderCannotBeMadeIsTriedAgain) {
  const TempFolder folder;
  const std::string path = folder.Path("log");
  Recorder recorder = Recorder::Start(path, RecorderOptions{}, kNow).value();
  std::filesystem::remove_all(path);
  folder.Write("log", "a file in its place");
  recorder.Record(Filler(100));
  for (int i = 0; i < 3; ++i) {
    const Status flushed = recorder.Flush(kNow);
    ASSERT_FALSE(flushed.ok());
    EXPECT_NE(flushed.error().message.find("cannot make"), std::string::npos);
  }
  std::filesystem::remove(path);
  EXPECT_FALSE(recorder.Flush(kNow).ok()) << "says what was lost";
  ASSERT_TRUE(recorder.Close(kNow).ok());
  EXPECT_EQ(InfoOf(recorder.path()).channels.at("CAMERA").events, 1);
}

HeardEvent PoseOf(std::int64_t session, std::int64_t seq) {
  terra_msg::pose_t pose{};
  pose.session = session;
  pose.seq = seq;
  return Heard(pose);
}

TEST(Recorder, CountsWhatIsMissingSinceARecordingThatWasKilled) {
  const TempFolder folder;
  {
    Recorder killed = StartIn(folder, RecorderOptions{});
    for (int seq = 1; seq <= 5; ++seq) killed.Record(PoseOf(9, seq));
    ASSERT_TRUE(killed.Flush(kNow).ok());
    killed.Record(PoseOf(9, 6));  // Not on the disk.
  }
  RecorderOptions options;
  options.session = 6;
  Recorder recorder = StartIn(folder, options);
  recorder.Record(PoseOf(9, 10));
  recorder.Record(PoseOf(9, 20));  // Lost on the bus, not by the recorder.
  recorder.Record(PoseOf(10, 7));  // Of a sender that was not there before.
  EXPECT_EQ(recorder.lost(), 4);
  ASSERT_TRUE(recorder.Close(kNow).ok());
  EXPECT_EQ(InfoOf(recorder.path()).lost, 4);
}

TEST(Recorder, MissesNothingSinceARecordingThatWasEndedInOrder) {
  const TempFolder folder;
  {
    Recorder ended = StartIn(folder, RecorderOptions{});
    ended.Record(PoseOf(9, 1));
    ASSERT_TRUE(ended.Close(kNow).ok());
  }
  RecorderOptions options;
  options.session = 6;
  Recorder recorder = StartIn(folder, options);
  recorder.Record(PoseOf(9, 10));
  EXPECT_EQ(recorder.lost(), 0);
}

TEST(Recorder, APartThatAnotherLoggerWritesIsNotDeleted) {
  const TempFolder folder;
  RecorderOptions other = SmallParts();
  other.session = 1;
  Recorder first = Recorder::Start(folder.Path(""), other, kNow - 1).value();
  RecorderOptions options = SmallParts();
  options.quota_bytes = options.part_bytes;
  Recorder second = StartIn(folder, options);
  EXPECT_TRUE(std::filesystem::exists(first.path()));
  EXPECT_TRUE(first.Close(kNow).ok());
}

TEST(Recorder, WhatMemoryCannotHoldIsCountedAndSaidInTheLog) {
  const TempFolder folder;
  RecorderOptions options;
  options.max_pending_bytes = 1'000;
  Recorder recorder = StartIn(folder, options);
  for (int i = 0; i < 10; ++i) recorder.Record(Filler(300));
  recorder.CountLost(5);
  ASSERT_TRUE(recorder.Flush(kNow).ok());
  const std::int64_t lost = recorder.lost();
  EXPECT_EQ(lost,
            5 + 10 - InfoOf(recorder.path()).channels.at("CAMERA").events);
  ASSERT_TRUE(recorder.Flush(kNow).ok());
  EXPECT_EQ(InfoOf(recorder.path()).lost, lost);
}

TEST(Recorder, AFolderThatCannotBeMadeIsAnErrorWithItsName) {
  const TempFolder folder;
  const std::string file = folder.Write("file", "x");
  const auto recorder = Recorder::Start(file + "/log", RecorderOptions{}, kNow);
  ASSERT_FALSE(recorder.ok());
  EXPECT_NE(recorder.error().message.find(file), std::string::npos);
}

TEST(LogFolder, KnowsItsOwnNames) {
  EXPECT_TRUE(IsPartName("terra-20260131T235959Z-0123abcd.000.lcmlog"));
  EXPECT_TRUE(IsPartName("terra-20260131T235959Z-0123abcd.1000.lcmlog"));
  EXPECT_FALSE(IsPartName("terra-20260131T235959Z-0123abcd.00.lcmlog"));
  EXPECT_FALSE(IsPartName("terra-20260131T235959Z-0123abcg.000.lcmlog"));
  EXPECT_FALSE(IsPartName("lcmlog-2026-01-31.00"));
  EXPECT_FALSE(IsPartName("terra-20260131T235959Z-0123abcd.000.lcmlog.gz"));
}

}  // namespace
}  // namespace terra::logger
