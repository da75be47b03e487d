#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace terra {

/// XXH3-64 of an id (Collet, xxHash): the same on every machine, so that what
/// is chosen by it is too.
std::uint64_t HashOfId(std::string_view id);

/// A list of ids that can be looked up, in 12 bytes an id. The strings must
/// outlive it and stay where they are.
class IdIndex {
 public:
  explicit IdIndex(std::vector<const std::string*> ids);

  std::size_t size() const { return ids_.size(); }
  const std::string& operator[](std::size_t place) const {
    return *ids_[place];
  }

  /// The place of an id; none = it is not in the list.
  std::optional<std::size_t> Find(std::string_view id) const;

  /// The first place whose id stands before as well.
  std::optional<std::size_t> FirstDouble() const;

 private:
  std::vector<const std::string*> ids_;
  std::vector<std::uint32_t> by_id_;  ///< Places, in order of ids, then places.
};

/// The index of a list of strings.
IdIndex IndexOf(const std::vector<std::string>& ids);

}  // namespace terra
