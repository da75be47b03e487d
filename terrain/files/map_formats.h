#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "terrain/files/map_file.h"
#include "terrain/legend.h"
#include "terrain/map.h"
#include "terrain/result.h"

namespace terra {

/// The readers behind ReadMap, one per format: content in, ids out. `name` is
/// the file's, for errors.

/// 8-bit grey: the values. 24-bit colour: the ids of exactly these colours.
Result<ByteRaster> ParsePngMap(std::string_view bytes, const Legend& legend,
                               const std::string& name);

Result<ByteRaster> ParseMovingAiMap(std::string_view text,
                                    const std::string& name);

/// The error of a rule for unknown ground where there is none.
Error NoUnknownGround(const std::string& place);

/// What a map_server yaml and its picture hold.
struct RosMap {
  ByteRaster ids;
  MapPlacement placement;
  std::vector<std::string> notices;  ///< As MapFile's.
};

/// Reads the yaml's text and the picture it names, relative to the yaml: a PGM
/// (P5, 8 bits) or a PNG of any kind, whose channels' mean counts, alpha among
/// them in trinary mode, as with map_server and Nav2.
/// `own_legend` = the user gave one, so `mode: scale` and `raw` may be read.
/// Which cells are unknown depends on whether `unknown` says what they cost.
Result<RosMap> ParseRosMap(std::string_view text, const std::string& name,
                           bool own_legend, const UnknownGround& unknown);

}  // namespace terra
