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

/// Every way there is: methods, key widths, and each instruction set that this
/// machine has.
std::vector<SearchWay> AllSearchWays();

/// Says whether every way, with and without the optimum as upper bound, finds
/// what ReferenceSearch finds: the same cost, on a path of single steps that
/// the cost rule accepts at that cost.
::testing::AssertionResult AllWaysAgree(const TerrainMap& map, Cell start,
                                        Cell goal);

}  // namespace terra::testing
