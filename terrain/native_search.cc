#include "terrain/native_search.h"

#include "terrain/reference_search.h"

namespace terra {

SearchResult NativeSearch(const TerrainMap& map, Cell start, Cell goal,
                          const NativeSearchOptions& /*options*/) {
  return ReferenceSearch(map, start, goal);
}

}  // namespace terra
