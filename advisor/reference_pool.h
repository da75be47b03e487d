#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "advisor/encoded_picture.h"
#include "advisor/prompt.h"
#include "terrain/cell.h"
#include "terrain/legend.h"
#include "terrain/map.h"
#include "terrain/result.h"

namespace terra::advisor {

/// One contrastive example: two feasible routes on a map that is no case's.
struct ReferencePair {
  TerrainMap map;
  std::int64_t map_id = 0;
  Route left;   ///< The native optimum in few waypoints: cheaper and longer.
  Route right;  ///< The shortest feasible route: dearer.
  ReferenceCosts costs;
  std::string sequence;  ///< RUGD: the sequence it comes from. Else empty.
};

/// How clear-cut a pair must be.
inline constexpr double kMinCostRatio = 1.10;    ///< C(right) / C(left).
inline constexpr double kMinLengthRatio = 1.02;  ///< length left / right.

/// Makes the pair of a map and its ends, when it qualifies: the right route
/// must cost at least kMinCostRatio of the left one, and the left one be at
/// least kMinLengthRatio as long.
/// Source: paper, LLM-Advisor (REA).
std::optional<ReferencePair> MakeReferencePair(const TerrainMap& map,
                                               Cell start, Cell goal,
                                               std::string sequence = "");

/// What a pair must not share with the case.
struct ReferenceExclusion {
  std::int64_t map_id = 0;
  std::string sequence;  ///< Empty = no rule.
};

/// The pairs of one legend, sorted by map_id. Immutable; the pictures are
/// encoded once, at the start. Threads may share it.
class ReferencePool {
 public:
  /// Checks every pair again: routes feasible with the costs stated, ratios
  /// kept, one legend, no map twice. Errors name the pair.
  static Result<ReferencePool> Create(std::vector<ReferencePair> pairs);

  /// Reads and writes the shipped form: JSON lines, first the legend, then a
  /// pair a line with its map's ids compressed.
  static Result<ReferencePool> Parse(std::string_view text);
  std::string Serialize() const;

  /// The pool that comes with the program, for the multiterrapath legend.
  static const ReferencePool& Builtin();

  const Legend& legend() const { return pairs_.front().map.legend(); }
  const std::vector<ReferencePair>& pairs() const { return pairs_; }

  /// Digest of all pairs, printed with results.
  const std::string& id() const { return id_; }

  /// Chooses by hash(seed, case id); the next allowed pair when that one is
  /// excluded. None when no pair is allowed or the legend is another.
  const ReferencePair* Choose(std::uint64_t seed, std::string_view case_id,
                              const Legend& legend,
                              const ReferenceExclusion& exclusion) const;

  /// The picture of a pair of this pool.
  std::shared_ptr<const EncodedPicture> PictureOf(
      const ReferencePair& pair) const;

 private:
  explicit ReferencePool(std::vector<ReferencePair> pairs);

  std::vector<ReferencePair> pairs_;
  std::vector<std::shared_ptr<const EncodedPicture>> pictures_;
  std::string id_;
};

}  // namespace terra::advisor
