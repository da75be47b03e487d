#include "advisor/reference_pool.h"

#include <xxhash.h>

#include <algorithm>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "advisor/encoding.h"
#include "advisor/fingerprint.h"
#include "advisor/pictures.h"
#include "advisor/wire_json.h"
#include "base/base64.h"
#include "terrain/digest.h"
#include "terrain/native_search.h"
#include "terrain/route_cost.h"
#include "terrain/route_text.h"
#include "terrain/segment.h"

namespace terra::advisor {

/// Defined in the source that the build makes of advisor/data.
extern const std::string_view kBuiltinReferencePool;

namespace {

using nlohmann::json;

constexpr std::string_view kFormat = "terra-reference-pool";
constexpr int kVersion = 1;

/// The map with every passable cell at cost 1, so that cost is length.
TerrainMap Flattened(const TerrainMap& map) {
  static const Legend legend =
      Legend::Create({{0, "passable", 1.0, {255, 255, 255}},
                      {1, "obstacle", kImpassable, {0, 0, 0}}})
          .value();
  ByteRaster ids = (map.classes() == 0).cast<std::uint8_t>();
  return TerrainMap::Create(std::move(ids), legend,
                            {map.cost_model().corner_cutting, 0})
      .value();
}

/// Why a pair cannot be an example, or nothing.
std::string WhatIsWrong(const ReferencePair& pair) {
  if (pair.left.size() < 2 || pair.right.size() < 2 ||
      pair.left.front() != pair.right.front() ||
      pair.left.back() != pair.right.back()) {
    return "its routes do not share two ends";
  }
  const RouteWalk left = WalkRoute(pair.map, pair.left);
  const RouteWalk right = WalkRoute(pair.map, pair.right);
  if (!left.feasible() || !right.feasible()) {
    return "a route is not feasible";
  }
  if (left.cost != pair.costs.left || right.cost != pair.costs.right) {
    return "a cost is not the one stated";
  }
  const TerrainMap flat = Flattened(pair.map);
  if (right.cost < kMinCostRatio * left.cost ||
      WalkRoute(flat, pair.left).cost <
          kMinLengthRatio * WalkRoute(flat, pair.right).cost) {
    return "its routes are too much alike";
  }
  return pair.map_id == MapId(pair.map) ? "" : "the map has another id";
}

json LegendJson(const Legend& legend) {
  json rows = json::array();
  for (const Terrain& terrain : legend.terrains()) {
    rows.push_back({{"id", terrain.id},
                    {"name", terrain.name},
                    {"cost", terrain.cost == kImpassable ? json(nullptr)
                                                         : json(terrain.cost)},
                    {"color", ToRgb(terrain.color)}});
  }
  return rows;
}

Result<Legend> LegendFromJson(const json& rows) {
  std::vector<Terrain> terrains;
  for (const json& row : rows) {
    terrains.push_back(
        {IntegerAt<int>(row, "id"), row.at("name").get<std::string>(),
         row.at("cost").is_null() ? kImpassable : row.at("cost").get<double>(),
         FromRgb(IntegerAt<std::uint32_t>(row, "color"))});
  }
  return Legend::Create(std::move(terrains));
}

std::string PairLine(const ReferencePair& pair) {
  const ByteRaster& ids = pair.map.ids();
  const std::string_view bytes(reinterpret_cast<const char*>(ids.data()),
                               static_cast<std::size_t>(ids.size()));
  const json line = {{"map_id", pair.map_id},
                     {"width", pair.map.width()},
                     {"height", pair.map.height()},
                     {"corner_cutting", pair.map.cost_model().corner_cutting},
                     {"clearance_cells", pair.map.cost_model().clearance_cells},
                     {"ids", Base64Encode(Compress(bytes))},
                     {"left", FormatRoute(pair.left)},
                     {"right", FormatRoute(pair.right)},
                     {"left_cost", pair.costs.left},
                     {"right_cost", pair.costs.right},
                     {"sequence", pair.sequence}};
  return line.dump();
}

Result<ReferencePair> PairFromJson(const json& line, const Legend& legend) {
  const int width = IntegerAt<int>(line, "width");
  const int height = IntegerAt<int>(line, "height");
  if (width < 1 || height < 1 || width > TerrainMap::kMaxSide ||
      height > TerrainMap::kMaxSide) {
    return Error{ErrorCode::kInvalid, "no such map size"};
  }
  ByteRaster ids(height, width);
  const auto size = static_cast<std::size_t>(ids.size());
  const auto packed = Base64Decode(line.at("ids").get<std::string>());
  const auto bytes = packed ? Decompress(*packed, size) : std::nullopt;
  if (!bytes || bytes->size() != size) {
    return Error{ErrorCode::kInvalid, "damaged ids"};
  }
  std::copy(bytes->begin(), bytes->end(), ids.data());
  auto map = TerrainMap::Create(std::move(ids), legend,
                                {line.at("corner_cutting").get<bool>(),
                                 IntegerAt<int>(line, "clearance_cells")});
  if (!map) return map.error();
  auto left = ParseRoute(line.at("left").get<std::string>());
  if (!left) return left.error();
  auto right = ParseRoute(line.at("right").get<std::string>());
  if (!right) return right.error();
  return ReferencePair{
      *std::move(map),
      IntegerAt<std::int64_t>(line, "map_id"),
      *std::move(left),
      *std::move(right),
      {line.at("left_cost").get<double>(), line.at("right_cost").get<double>()},
      line.at("sequence").get<std::string>()};
}

Error AtLine(int number, const std::string& what) {
  return {ErrorCode::kInvalid,
          "reference pool, line " + std::to_string(number) + ": " + what};
}

}  // namespace

std::optional<ReferencePair> MakeReferencePair(const TerrainMap& map,
                                               Cell start, Cell goal,
                                               std::string sequence) {
  const SearchResult cheapest = NativeSearch(map, start, goal);
  const SearchResult shortest = NativeSearch(Flattened(map), start, goal);
  if (!cheapest.found() || !shortest.found()) {
    return std::nullopt;
  }
  ReferencePair pair{map,
                     MapId(map),
                     CornersOf(cheapest.cells),
                     CornersOf(shortest.cells),
                     {},
                     std::move(sequence)};
  pair.costs = {WalkRoute(map, pair.left).cost,
                WalkRoute(map, pair.right).cost};
  if (!WhatIsWrong(pair).empty()) {
    return std::nullopt;
  }
  return pair;
}

ReferencePool::ReferencePool(std::vector<ReferencePair> pairs)
    : pairs_(std::move(pairs)) {
  Fingerprint hash;
  for (const ReferencePair& pair : pairs_) {
    hash.Add(pair.map_id);
    hash.Add(FormatRoute(pair.left));
    hash.Add(FormatRoute(pair.right));
    pictures_.push_back(std::make_shared<const EncodedPicture>(
        EncodePicture(DrawReferencePair(pair.map, pair.left, pair.right))));
  }
  id_ = hash.Hex();
}

Result<ReferencePool> ReferencePool::Create(std::vector<ReferencePair> pairs) {
  if (pairs.empty()) {
    return Error{ErrorCode::kInvalid, "reference pool: no pair in it"};
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const ReferencePair& a, const ReferencePair& b) {
              return a.map_id < b.map_id;
            });
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const ReferencePair& pair = pairs[i];
    std::string wrong = WhatIsWrong(pair);
    if (i > 0 && pair.map_id == pairs[i - 1].map_id) wrong = "its map is twice";
    if (!(pair.map.legend() == pairs.front().map.legend())) {
      wrong = "its legend is not that of the others";
    }
    if (!wrong.empty()) {
      return Error{
          ErrorCode::kInvalid,
          "reference pool, map " + std::to_string(pair.map_id) + ": " + wrong};
    }
  }
  return ReferencePool(std::move(pairs));
}

Result<ReferencePool> ReferencePool::Parse(std::string_view text) {
  std::vector<ReferencePair> pairs;
  std::optional<Legend> legend;
  int number = 0;
  while (!text.empty()) {
    const std::string_view row = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), row.size() + 1));
    ++number;
    try {
      const json line = json::parse(row);
      if (legend) {
        auto pair = PairFromJson(line, *legend);
        if (!pair) return AtLine(number, pair.error().message);
        pairs.push_back(*std::move(pair));
        continue;
      }
      if (line.at("format") != kFormat || line.at("version") != kVersion) {
        return AtLine(number, "no reference pool of version 1");
      }
      auto read = LegendFromJson(line.at("legend"));
      if (!read) return AtLine(number, read.error().message);
      legend = *std::move(read);
    } catch (const json::exception& error) {
      return AtLine(number, JsonFault(error));
    }
  }
  return Create(std::move(pairs));
}

std::string ReferencePool::Serialize() const {
  const json head = {{"format", kFormat},
                     {"version", kVersion},
                     {"legend", LegendJson(legend())}};
  std::string text = head.dump() + "\n";
  for (const ReferencePair& pair : pairs_) {
    text += PairLine(pair) + "\n";
  }
  return text;
}

const ReferencePool& ReferencePool::Builtin() {
  static const ReferencePool pool = Parse(kBuiltinReferencePool).value();
  return pool;
}

const ReferencePair* ReferencePool::Choose(
    std::uint64_t seed, std::string_view case_id, const Legend& wanted,
    const ReferenceExclusion& exclusion) const {
  if (!(legend() == wanted)) {
    return nullptr;
  }
  const std::string key = std::to_string(seed) + ":" + std::string(case_id);
  const std::size_t first = XXH64(key.data(), key.size(), 0) % pairs_.size();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const ReferencePair& pair = pairs_[(first + i) % pairs_.size()];
    if (pair.map_id != exclusion.map_id &&
        (exclusion.sequence.empty() || pair.sequence != exclusion.sequence)) {
      return &pair;
    }
  }
  return nullptr;
}

std::shared_ptr<const EncodedPicture> ReferencePool::PictureOf(
    const ReferencePair& pair) const {
  const auto at = static_cast<std::size_t>(&pair - pairs_.data());
  TERRA_REQUIRE(at < pairs_.size());
  return pictures_[at];
}

}  // namespace terra::advisor
