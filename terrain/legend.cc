#include "terrain/legend.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace terra {
namespace {

Error Invalid(std::string message) {
  return Error{ErrorCode::kInvalid, std::move(message)};
}

std::string Label(const Terrain& terrain) {
  return "terrain id " + std::to_string(terrain.id) + " (" + terrain.name + ")";
}

bool IsCost(double cost) {
  return cost == kImpassable ||
         (cost >= Legend::kMinCost && cost <= Legend::kMaxCost);
}

bool IsName(const std::string& name) {
  return !name.empty() && name.size() <= Legend::kMaxNameBytes &&
         std::none_of(name.begin(), name.end(), [](char c) {
           return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
         });
}

}  // namespace

Legend::Legend(std::vector<Terrain> terrains) : terrains_(std::move(terrains)) {
  row_of_id_.fill(-1);
  for (std::size_t row = 0; row < terrains_.size(); ++row) {
    row_of_id_[static_cast<std::size_t>(terrains_[row].id)] =
        static_cast<std::int16_t>(row);
  }
}

Result<Legend> Legend::Create(std::vector<Terrain> terrains) {
  if (terrains.empty()) {
    return Invalid("a legend needs at least one terrain");
  }
  std::sort(terrains.begin(), terrains.end(),
            [](const Terrain& a, const Terrain& b) {
              return a.id < b.id;
            });
  std::set<std::uint32_t> colors;
  std::set<double> finite_costs;
  for (std::size_t row = 0; row < terrains.size(); ++row) {
    const Terrain& terrain = terrains[row];
    if (terrain.id < 0 || terrain.id > 255) {
      return Invalid(Label(terrain) + ": ids are 0 to 255");
    }
    if (row > 0 && terrains[row - 1].id == terrain.id) {
      return Invalid(Label(terrain) + " has two rows");
    }
    if (!IsName(terrain.name)) {
      return Invalid("terrain id " + std::to_string(terrain.id) +
                     ": a name is 1 to 31 bytes without control characters");
    }
    if (!IsCost(terrain.cost)) {
      return Invalid(Label(terrain) + ": cost " + std::to_string(terrain.cost) +
                     " is neither inf nor within 0.001 to 1000000");
    }
    if (!colors.insert(ToRgb(terrain.color)).second) {
      return Invalid(Label(terrain) + " has the colour of another terrain");
    }
    if (std::isfinite(terrain.cost)) {
      finite_costs.insert(terrain.cost);
    }
  }
  if (finite_costs.size() > 255) {
    return Invalid("more than 255 different finite costs");
  }
  return Legend(std::move(terrains));
}

const Terrain* Legend::Find(int id) const {
  if (id < 0 || id > 255) {
    return nullptr;
  }
  const std::int16_t row = row_of_id_[static_cast<std::size_t>(id)];
  return row < 0 ? nullptr : &terrains_[static_cast<std::size_t>(row)];
}

const Terrain* Legend::FindColor(Color color) const {
  const auto found = std::find_if(terrains_.begin(), terrains_.end(),
                                  [color](const Terrain& t) {
                                    return t.color == color;
                                  });
  return found == terrains_.end() ? nullptr : &*found;
}

}  // namespace terra
