#include "logger/recorder.h"

#include <algorithm>
#include <filesystem>
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
  folder.Write("terra-20200101T000000Z-00000001.000.lcmlog",
               std::string(30'000, 'x'));
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
