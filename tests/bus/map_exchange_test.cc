#include "bus/map_exchange.h"

#include <set>

#include <gtest/gtest.h>

#include "bus/map_receiver.h"
#include "bus/map_sender.h"
#include "terrain/digest.h"
#include "tests/support/random_map.h"
#include "tests/support/virtual_network.h"

namespace terra::bus {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::Random;
using testing::RandomMap;
using testing::RandomMapKind;
using testing::VirtualNetwork;

class SenderNode : public Node {
 public:
  explicit SenderNode(Outbox& out) : sender(out) {
    Listen<terra_msg::map_request_t>([this](const auto& m, Time now) {
      sender.OnRequest(m, now);
    });
  }
  Time Advance(Time now) override { return sender.Advance(now); }
  std::string state() const override { return ""; }
  MapSender sender;
};

class ReceiverNode : public Node {
 public:
  explicit ReceiverNode(Outbox& out) : receiver(out) {
    Listen<terra_msg::map_header_t>([this](const auto& m, Time now) {
      receiver.OnHeader(m, now);
    });
    Listen<terra_msg::map_tile_t>([this](const auto& m, Time now) {
      receiver.OnTiles(m, now);
    });
  }
  Time Advance(Time now) override { return receiver.Advance(now); }
  std::string state() const override { return receiver.state(); }
  MapReceiver receiver;
};

class MapExchangeTest : public ::testing::Test {
 protected:
  void Serve(const TerrainMap& map) {
    sender_ = static_cast<SenderNode*>(&network_.Start("map", [](Outbox& out) {
      return std::make_unique<SenderNode>(out);
    }));
    Put(map);
  }
  void Put(const TerrainMap& map) {
    sender_->sender.SetMap(map.ids(), MakeMapHeader(map));
  }
  MapReceiver& Join(const std::string& name) {
    return static_cast<ReceiverNode&>(
               network_.Start(name,
                              [](Outbox& out) {
                                return std::make_unique<ReceiverNode>(out);
                              }))
        .receiver;
  }
  bool Arrives(const MapReceiver& receiver, const TerrainMap& map,
               Duration within) {
    const std::int64_t id = MapId(map);
    return network_.RunUntil(
               [&] {
                 return receiver.map_id() == id;
               },
               within) &&
           (receiver.map()->map.ids() == map.ids()).all() &&
           receiver.map()->map.legend() == map.legend() &&
           receiver.map()->map.cost_model() == map.cost_model();
  }

  VirtualNetwork network_;
  SenderNode* sender_ = nullptr;
  Random random_{5};
};

TEST_F(MapExchangeTest, AMapArrivesWhole) {
  const TerrainMap map =
      RandomMap(random_, 300, 200, RandomMapKind::kNoise, CostModel{false, 2});
  Serve(map);
  EXPECT_TRUE(Arrives(Join("a"), map, seconds(1)));
}

TEST_F(MapExchangeTest, LateReceiversGetItToo) {
  const TerrainMap map =
      RandomMap(random_, 300, 200, RandomMapKind::kRectangles);
  Serve(map);
  network_.Run(seconds(10));
  EXPECT_TRUE(Arrives(Join("late"), map, seconds(1)));
}

TEST_F(MapExchangeTest, AMapArrivesThoughOneMessageInThreeIsLost) {
  const TerrainMap map = RandomMap(random_, 900, 700, RandomMapKind::kNoise);
  network_.LoseOneIn(3);
  Serve(map);
  MapReceiver& first = Join("a");
  MapReceiver& second = Join("b");
  EXPECT_TRUE(Arrives(first, map, seconds(10)));
  EXPECT_TRUE(Arrives(second, map, seconds(10)));
}

TEST_F(MapExchangeTest, AnUpdateMovesOnlyTheTilesThatChanged) {
  const TerrainMap map = RandomMap(random_, 600, 600, RandomMapKind::kNoise);
  Serve(map);
  MapReceiver& receiver = Join("a");
  ASSERT_TRUE(Arrives(receiver, map, seconds(2)));
  network_.ForgetSent();

  ByteRaster ids = map.ids();
  ids(5, 5) = ids(5, 5) == 1 ? 2 : 1;
  const TerrainMap changed = *TerrainMap::Create(ids, map.legend());
  Put(changed);
  EXPECT_TRUE(Arrives(receiver, changed, seconds(1)));
  const auto tiles = network_.Sent<terra_msg::map_tile_t>();
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_EQ(tiles[0].num_tiles, 1);
}

TEST_F(MapExchangeTest, TheMapStaysInForceUntilTheNextIsComplete) {
  const TerrainMap map = RandomMap(random_, 300, 300, RandomMapKind::kNoise);
  Serve(map);
  MapReceiver& receiver = Join("a");
  ASSERT_TRUE(Arrives(receiver, map, seconds(1)));
  const TerrainMap next = RandomMap(random_, 300, 300, RandomMapKind::kNoise);
  const terra_msg::map_header_t header = MakeMapHeader(next);
  terra_msg::map_header_t stamped = header;
  stamped.session = 4;
  stamped.seq = 1;
  network_.Kill("map");
  network_.Inject(stamped);
  network_.Run(seconds(5));
  EXPECT_EQ(receiver.map_id(), MapId(map));
  EXPECT_EQ(receiver.missing(), 9);
}

// Five receivers that ask for everything at once are served by one copy.
TEST_F(MapExchangeTest, ATileGoesOutOncePer200Milliseconds) {
  const TerrainMap map = RandomMap(random_, 600, 600, RandomMapKind::kNoise);
  Serve(map);
  for (const char* name : {"a", "b", "c", "d", "e"}) Join(name);
  network_.Run(milliseconds(190));
  std::multiset<int> sent;
  for (const auto& message : network_.Sent<terra_msg::map_tile_t>()) {
    sent.insert(message.tile_index.begin(), message.tile_index.end());
  }
  ASSERT_EQ(sent.size(), 25u);
  for (int tile = 0; tile < 25; ++tile) EXPECT_EQ(sent.count(tile), 1u);
}

TEST_F(MapExchangeTest, NoMoreThan20KilobytesGoOutPerMillisecond) {
  const TerrainMap map = RandomMap(random_, 1500, 1500, RandomMapKind::kNoise);
  Serve(map);
  Join("a");
  network_.Run(milliseconds(1));
  network_.ForgetSent();
  network_.Run(milliseconds(20));
  std::size_t bytes = 0;
  for (const auto& message : network_.Sent<terra_msg::map_tile_t>()) {
    EXPECT_LE(message.tile_data.size(), kTileMessageBytes);
    bytes += message.tile_data.size();
  }
  EXPECT_LE(bytes, 21 * kTileMessageBytes);
  EXPECT_GE(bytes, 10 * kTileMessageBytes);
}

TEST_F(MapExchangeTest, ARestartedMapServerTakesOverAndTheOldOneIsReported) {
  const TerrainMap map = RandomMap(random_, 200, 200, RandomMapKind::kNoise);
  Serve(map);
  MapReceiver& receiver = Join("a");
  ASSERT_TRUE(Arrives(receiver, map, seconds(1)));
  const std::int64_t old_session = receiver.sender().session();
  const TerrainMap next = RandomMap(random_, 200, 200, RandomMapKind::kNoise);
  Serve(next);
  EXPECT_TRUE(Arrives(receiver, next, seconds(1)));
  terra_msg::map_header_t late = MakeMapHeader(map);
  late.session = old_session;
  late.seq = 1000;
  network_.Inject(late);
  network_.Run(seconds(1));
  EXPECT_EQ(receiver.map_id(), MapId(next));
  EXPECT_EQ(receiver.sender().from_replaced(), 1);
}

TEST_F(MapExchangeTest, ForgedTilesAreNotTaken) {
  const TerrainMap map = RandomMap(random_, 200, 200, RandomMapKind::kNoise);
  MapReceiver& receiver = Join("a");
  terra_msg::map_header_t header = MakeMapHeader(map);
  header.session = 1;
  header.seq = 1;
  network_.Inject(header);
  terra_msg::map_tile_t tile{};
  const std::vector<std::uint8_t> forged(128 * 128, 3);
  const std::vector<std::uint8_t> frame = CompressTile(forged);
  tile.num_tiles = 3;
  tile.tile_index = {0, 99, -1};
  tile.tile_digest = {header.tile_digest[0], 0, 0};
  tile.tile_size = {static_cast<std::int32_t>(frame.size()), -5, 1 << 30};
  tile.tile_data.assign(frame.begin(), frame.end());
  tile.num_bytes = static_cast<std::int32_t>(frame.size());
  network_.Inject(tile);
  network_.Run(milliseconds(10));
  EXPECT_EQ(receiver.missing(), 4);
}

// Ids without a legend row make no map; collecting it again and again would
// flood the bus.
TEST_F(MapExchangeTest, ACompleteMapThatIsInvalidIsNotAskedForAgain) {
  ByteRaster ids = ByteRaster::Constant(130, 130, 200);
  const TerrainMap legal = RandomMap(random_, 130, 130, RandomMapKind::kNoise);
  terra_msg::map_header_t header = MakeMapHeader(legal);
  header.tile_digest = TileDigests(ids, TileGrid{130, 130});
  header.map_id = MapId(130, 130, 128, legal.legend(), legal.cost_model(),
                        header.tile_digest);
  Serve(legal);
  sender_->sender.SetMap(ids, header);
  MapReceiver& receiver = Join("a");
  network_.Run(seconds(5));
  EXPECT_EQ(receiver.map(), nullptr);
  EXPECT_FALSE(receiver.last_error().empty());
  EXPECT_EQ(network_.Sent<terra_msg::map_request_t>().size(), 1u);
}

TEST(ReadMapHeaderTest, RefusesEachWrongField) {
  Random random(9);
  const terra_msg::map_header_t good =
      MakeMapHeader(RandomMap(random, 300, 200, RandomMapKind::kNoise));
  ASSERT_TRUE(ReadMapHeader(good).ok());
  using Change = void (*)(terra_msg::map_header_t&);
  const std::vector<Change> changes = {[](auto& h) {
                                         h.width = 0;
                                       },
                                       [](auto& h) {
                                         h.width = 8193;
                                       },
                                       [](auto& h) {
                                         h.height = -1;
                                       },
                                       [](auto& h) {
                                         h.tile_side = 0;
                                       },
                                       [](auto& h) {
                                         h.corner_cutting = 2;
                                       },
                                       [](auto& h) {
                                         h.clearance_cells = -1;
                                       },
                                       [](auto& h) {
                                         h.clearance_cells = 1;
                                       },
                                       [](auto& h) {
                                         --h.num_tiles;
                                       },
                                       [](auto& h) {
                                         h.map_id += 1;
                                       },
                                       [](auto& h) {
                                         h.terrain_cost[0] = -1;
                                       },
                                       [](auto& h) {
                                         h.terrain_cost[0] = std::nan("");
                                       },
                                       [](auto& h) {
                                         h.terrain_id[0] = h.terrain_id[1];
                                       },
                                       [](auto& h) {
                                         h.tile_digest[0] ^= 1;
                                       }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    terra_msg::map_header_t header = good;
    changes[i](header);
    EXPECT_FALSE(ReadMapHeader(header).ok()) << "change " << i;
  }
}

TEST(UnpackTileTest, TakesExactlyTheCellsThatAreExpected) {
  const std::vector<std::uint8_t> ids(100, 7);
  const std::vector<std::uint8_t> frame = CompressTile(ids);
  EXPECT_EQ(*UnpackTile(frame, 100), ids);
  EXPECT_FALSE(UnpackTile(frame, 99).ok());
  EXPECT_FALSE(UnpackTile(frame, 101).ok());
  EXPECT_FALSE(UnpackTile(std::span(frame).first(5), 100).ok());
  EXPECT_FALSE(UnpackTile({}, 100).ok());
}

}  // namespace
}  // namespace terra::bus
