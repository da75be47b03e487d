#include "terrain/files/id_index.h"

#include <xxhash.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "terrain/require.h"

namespace terra {

std::uint64_t HashOfId(std::string_view id) {
  return XXH3_64bits(id.data(), id.size());
}

IdIndex::IdIndex(std::vector<const std::string*> ids)
    : ids_(std::move(ids)), by_id_(ids_.size()) {
  TERRA_REQUIRE(ids_.size() < std::numeric_limits<std::uint32_t>::max());
  std::iota(by_id_.begin(), by_id_.end(), 0U);
  std::sort(by_id_.begin(), by_id_.end(),
            [&](std::uint32_t a, std::uint32_t b) {
              const int order = ids_[a]->compare(*ids_[b]);
              return order != 0 ? order < 0 : a < b;
            });
}

std::optional<std::size_t> IdIndex::Find(std::string_view id) const {
  const auto found =
      std::lower_bound(by_id_.begin(), by_id_.end(), id,
                       [&](std::uint32_t place, std::string_view wanted) {
                         return *ids_[place] < wanted;
                       });
  if (found == by_id_.end() || *ids_[*found] != id) return std::nullopt;
  return *found;
}

std::optional<std::size_t> IdIndex::FirstDouble() const {
  std::optional<std::size_t> first;
  for (std::size_t i = 1; i < by_id_.size(); ++i) {
    const std::size_t place = by_id_[i];
    const bool twice = *ids_[by_id_[i - 1]] == *ids_[place];
    if (twice && (!first || place < *first)) first = place;
  }
  return first;
}

IdIndex IndexOf(const std::vector<std::string>& ids) {
  std::vector<const std::string*> pointers;
  pointers.reserve(ids.size());
  for (const std::string& id : ids) pointers.push_back(&id);
  return IdIndex(std::move(pointers));
}

}  // namespace terra
