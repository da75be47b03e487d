#include "terrain/builtin_legends.h"

#include <array>
#include <utility>

namespace terra {
namespace {

Legend Make(std::vector<Terrain> terrains) {
  return Legend::Create(std::move(terrains)).value();
}

Terrain Row(int id, std::string name, double cost, std::uint32_t rgb) {
  return Terrain{id, std::move(name), cost, FromRgb(rgb)};
}

}  // namespace

const Legend& MultiTerraPathLegend() {
  static const Legend legend = Make({
      Row(0, "terrain 0", 1, 0xFFFFFF),
      Row(1, "terrain 1", 3, 0xFF0000),
      Row(2, "terrain 2", 3.5, 0x00FF00),
      Row(3, "terrain 3", 4, 0x0000FF),
      Row(4, "terrain 4", 4.5, 0x00FFFF),
      Row(5, "terrain 5", 5, 0xFF00FF),
      Row(6, "terrain 6", 5, 0xFFFF00),
      Row(7, "terrain 7", 6, 0xFFA500),
      Row(8, "terrain 8", 6.5, 0xA52A2A),
      Row(9, "terrain 9", 7, 0x808080),
      Row(10, "terrain 10", 8, 0xFFC0CB),
      Row(11, "obstacle", kImpassable, 0x000000),
  });
  return legend;
}

const Legend& RugdLegend() {
  static const Legend legend = Make({
      Row(0, "void", kImpassable, 0x000000),
      Row(1, "dirt", 2.2, 0x6C4014),
      Row(2, "sand", 3.5, 0xFFE5CC),
      Row(3, "grass", 1.8, 0x006600),
      Row(4, "tree", kImpassable, 0x00FF00),
      Row(5, "pole", kImpassable, 0x009999),
      Row(6, "water", kImpassable, 0x0080FF),
      Row(7, "sky", kImpassable, 0x0000FF),
      Row(8, "vehicle", kImpassable, 0xFFFF00),
      Row(9, "container/generic-object", kImpassable, 0xFF007F),
      Row(10, "asphalt", 1.2, 0x404040),
      Row(11, "gravel", 1.5, 0xFF8000),
      Row(12, "building", kImpassable, 0xFF0000),
      Row(13, "mulch", 2.5, 0x994C00),
      Row(14, "rock-bed", 3.0, 0x666600),
      Row(15, "log", kImpassable, 0x660000),
      Row(16, "bicycle", kImpassable, 0x00FF80),
      Row(17, "person", kImpassable, 0xCC99FF),
      Row(18, "fence", kImpassable, 0x6600CC),
      Row(19, "bush", kImpassable, 0xFF99CC),
      Row(20, "sign", kImpassable, 0x006666),
      Row(21, "rock", kImpassable, 0x99CCFF),
      Row(22, "bridge", kImpassable, 0x66FFFF),
      Row(23, "concrete", 1.0, 0x65650B),
      Row(24, "picnic-table", kImpassable, 0x72552F),
  });
  return legend;
}

const Legend& MovingAiLegend() {
  static const Legend legend = Make({
      Row(kMovingAiGround, "ground", 1, 0xFFFFFF),
      Row(kMovingAiSwamp, "swamp", 3, 0x8FBC5A),
      Row(kMovingAiWater, "water", kImpassable, 0x4080FF),
      Row(kMovingAiTrees, "trees", kImpassable, 0x206020),
      Row(kMovingAiOut, "out of bounds", kImpassable, 0x000000),
  });
  return legend;
}

const Legend& OccupancyLegend() {
  static const Legend legend = Make({
      Row(kOccupancyFree, "free", 1, 0xFFFFFF),
      Row(kOccupancyOccupied, "occupied", kImpassable, 0x000000),
      Row(kOccupancyUnknown, "unknown", kImpassable, 0x808080),
  });
  return legend;
}

const Legend* FindBuiltinLegend(std::string_view name) {
  if (name == "multiterrapath") return &MultiTerraPathLegend();
  if (name == "rugd") return &RugdLegend();
  if (name == "movingai") return &MovingAiLegend();
  if (name == "occupancy") return &OccupancyLegend();
  return nullptr;
}

std::vector<std::string_view> BuiltinLegendNames() {
  return {"multiterrapath", "rugd", "movingai", "occupancy"};
}

}  // namespace terra
