#include "bus/codec.h"

#include <algorithm>

#include "terrain/steps.h"

namespace terra::bus {
namespace {

std::uint8_t DirectionOf(Cell from, Cell to) {
  const auto found = std::find(kSteps.begin(), kSteps.end(),
                               Cell{to.x - from.x, to.y - from.y});
  TERRA_REQUIRE(found != kSteps.end());
  return static_cast<std::uint8_t>(found - kSteps.begin());
}

}  // namespace

Chain EncodeChain(const CellPath& cells) {
  Chain chain;
  if (cells.empty()) return chain;
  const std::size_t steps = cells.size() - 1;
  chain.num_steps = static_cast<std::int32_t>(steps);
  chain.bytes.assign((steps + 1) / 2, 0);
  for (std::size_t i = 0; i < steps; ++i) {
    const int shift = i % 2 == 0 ? 0 : 4;
    chain.bytes[i / 2] = static_cast<std::uint8_t>(
        chain.bytes[i / 2] | DirectionOf(cells[i], cells[i + 1]) << shift);
  }
  return chain;
}

Result<CellPath> DecodeChain(Cell first, const Chain& chain) {
  if (chain.num_steps < 0 || chain.num_steps > kMaxSteps ||
      chain.bytes.size() !=
          (static_cast<std::size_t>(chain.num_steps) + 1) / 2) {
    return Error{ErrorCode::kInvalid, "chain length and steps disagree"};
  }
  CellPath cells = {first};
  std::int64_t x = first.x;
  std::int64_t y = first.y;
  for (std::size_t i = 0; i < chain.bytes.size() * 2; ++i) {
    const int direction = chain.bytes[i / 2] >> (i % 2 == 0 ? 0 : 4) & 0xF;
    if (i >= static_cast<std::size_t>(chain.num_steps)) {
      if (direction == 0) break;
      return Error{ErrorCode::kInvalid, "the unused half of a chain is not 0"};
    }
    if (direction > 7) {
      return Error{ErrorCode::kInvalid, "a chain direction above 7"};
    }
    const Cell step = kSteps[static_cast<std::size_t>(direction)];
    x += step.x;
    y += step.y;
    if (x != static_cast<int>(x) || y != static_cast<int>(y)) {
      return Error{ErrorCode::kInvalid, "a chain leaves the integers"};
    }
    cells.push_back(Cell{static_cast<int>(x), static_cast<int>(y)});
  }
  return cells;
}

}  // namespace terra::bus
