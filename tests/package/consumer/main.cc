// Uses the verifier, a message type and the receiver from outside the project.
#include <cstdio>
#include <vector>

#include "terra_msg/verdict_t.hpp"

#include "bus/udpm_receiver.h"
#include "terrain/builtin_legends.h"
#include "verifier/verify.h"

int main() {
  if (terra::bus::UdpmReceiver::Open("memq://").ok()) return 1;
  const auto map = terra::TerrainMap::Create(terra::ByteRaster::Zero(5, 5),
                                             terra::MultiTerraPathLegend());
  const terra::Route detour = {{0, 0}, {4, 0}, {4, 4}};
  const terra::Route straight = {{0, 0}, {4, 4}};
  const auto comparison = terra::verifier::CompareRoutes(
      map.value(), {0, 0}, {4, 4}, detour, straight);
  terra_msg::verdict_t verdict{};
  verdict.code = static_cast<std::int16_t>(comparison.code);
  std::printf("%s\n",
              std::string(terra::verifier::CodeName(comparison.code)).c_str());
  return verdict.code == terra_msg::verdict_t::CODE_ACCEPTED ? 0 : 1;
}
