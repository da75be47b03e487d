#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "terrain/native_search.h"

namespace terra::testing {

/// A way in which a native search can be made, forced.
struct SearchWay {
  std::string name;
  NativeSearchOptions options;
};

/// Every way there is: A* with each width of keys; sweep and automatic choice
/// with each instruction set that this machine has.
std::vector<SearchWay> AllSearchWays();

/// Says whether every way, without an upper bound, with the optimum as one and
/// with a dearer one, finds what ReferenceSearch finds, the same cost, on the
/// path that the tie rule names (RuledPath), cell for cell. A way that
/// does not use the method it is to use has failed too.
::testing::AssertionResult AllWaysAgree(const TerrainMap& map, Cell start,
                                        Cell goal);

}  // namespace terra::testing
