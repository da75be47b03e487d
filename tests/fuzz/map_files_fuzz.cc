// Map pictures and texts. The first byte chooses the reader.

#include <string>

#include "terrain/builtin_legends.h"
#include "terrain/files/image.h"
#include "terrain/files/map_formats.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text = terra::fuzz::Text(data + 1, size - 1);
  switch (data[0] % 4) {
    case 0: {
      const auto ids =
          terra::ParsePngMap(text, terra::MultiTerraPathLegend(), "input");
      terra::fuzz::Require(!ids || ids->size() > 0, "a map has cells");
      break;
    }
    case 1: {
      const auto ids = terra::ParseMovingAiMap(text, "input");
      terra::fuzz::Require(!ids || ids->size() > 0, "a map has cells");
      break;
    }
    case 2:
      terra::fuzz::RequireReason(terra::DecodePgm(text, "input"));
      break;
    default:
      // Names of files that exist are none of an input's business.
      if (text.find('/') != std::string_view::npos) return 0;
      terra::fuzz::RequireReason(terra::ParseRosMap(text, "/nowhere/map.yaml",
                                                    /*own_legend=*/true, {}));
  }
  return 0;
}
