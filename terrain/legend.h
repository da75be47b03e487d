#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "terrain/result.h"

namespace terra {

/// The cost of a terrain that cannot be crossed.
inline constexpr double kImpassable = std::numeric_limits<double>::infinity();

/// 8 bits per channel.
struct Color {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;

  friend bool operator==(const Color&, const Color&) = default;
};

/// Returns 0xRRGGBB.
constexpr std::uint32_t ToRgb(Color c) {
  return (std::uint32_t{c.r} << 16) | (std::uint32_t{c.g} << 8) | c.b;
}
constexpr Color FromRgb(std::uint32_t rgb) {
  return Color{static_cast<std::uint8_t>(rgb >> 16),
               static_cast<std::uint8_t>(rgb >> 8),
               static_cast<std::uint8_t>(rgb)};
}

/// One row of a legend.
struct Terrain {
  int id = 0;                 ///< 0 to 255, as stored in the map.
  std::string name;           ///< At most 31 bytes, no control characters.
  double cost = kImpassable;  ///< Per cell of travel; > 0, or kImpassable.
  Color color;

  friend bool operator==(const Terrain&, const Terrain&) = default;
};

/// What the ids of a map mean. Immutable; threads may share it.
class Legend {
 public:
  static constexpr int kMaxNameBytes = 31;
  /// A cost below or above makes sums of a whole map lose their precision.
  static constexpr double kMinCost = 1e-3;
  static constexpr double kMaxCost = 1e6;

  /// Errors: no rows, an id twice or outside 0..255, two ids of one colour, a
  /// bad name, a cost that is neither in [kMinCost, kMaxCost] nor infinite,
  /// more than 255 different finite costs.
  static Result<Legend> Create(std::vector<Terrain> terrains);

  /// In order of id.
  const std::vector<Terrain>& terrains() const { return terrains_; }

  /// Returns the row of an id, or nullptr.
  const Terrain* Find(int id) const;

  /// Returns the row of a colour, or nullptr; never the nearest one.
  const Terrain* FindColor(Color color) const;

  friend bool operator==(const Legend&, const Legend&) = default;

 private:
  explicit Legend(std::vector<Terrain> terrains);

  std::vector<Terrain> terrains_;
  std::array<std::int16_t, 256> row_of_id_{};  // -1 = no such id
};

}  // namespace terra
