#include "benchmark/reference_builder.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "benchmark/generate_dataset.h"
#include "benchmark/map_generator.h"
#include "terrain/files/case_reader.h"
#include "terrain/require.h"

namespace terra::benchmark {
namespace {

using advisor::MakeReferencePair;
using advisor::ReferencePair;
using advisor::ReferencePool;

/// Far more maps than a pair needs; a bound for parameters that admit none.
constexpr int kMapsPerPair = 200;

Error TooFew(std::size_t found, int count) {
  return {ErrorCode::kNotFound, "only " + std::to_string(found) + " of " +
                                    std::to_string(count) +
                                    " reference pairs: too few maps qualify"};
}

}  // namespace

Result<ReferencePool> BuildGeneratedPool(std::uint64_t seed, int count) {
  TERRA_REQUIRE(count >= 1);
  if (seed == kReleasedSeed) {
    return Error{ErrorCode::kInvalid,
                 "the seed of the released set: its maps are cases"};
  }
  const Subset subsets[] = {Subset::kEasy, Subset::kHard};
  std::vector<ReferencePair> pairs;
  int next[] = {0, 0};
  for (int made = 0; made < count * kMapsPerPair; ++made) {
    const auto turn = pairs.size() % 2;
    const GeneratedCase drawn = GenerateCase(
        subsets[turn], seed, next[turn]++, CalibratedParameters(subsets[turn]));
    auto pair = MakeReferencePair(drawn.map, drawn.start, drawn.goal);
    if (!pair) continue;
    pairs.push_back(*std::move(pair));
    if (pairs.size() == static_cast<std::size_t>(count)) {
      return ReferencePool::Create(std::move(pairs));
    }
  }
  return TooFew(pairs.size(), count);
}

Result<ReferencePool> BuildDatasetPool(const std::string& folder, int count,
                                       const UnknownGround& unknown) {
  TERRA_REQUIRE(count >= 1);
  const auto dataset = OpenDataset(folder, unknown);
  if (!dataset) return dataset.error();
  auto cases = CaseReader::Open(folder);
  if (!cases) return cases.error();
  std::vector<ReferencePair> pairs;
  while (pairs.size() < static_cast<std::size_t>(count)) {
    const auto next = cases->Next();
    if (!next) return next.error();
    if (!next->has_value()) break;
    const DatasetCase& one = **next;
    const auto map = ReadCaseMap(*dataset, one);
    if (!map) return map.error();
    const auto sequence = one.extra.find("sequence");
    auto pair =
        MakeReferencePair(*map, one.start, one.goal,
                          sequence == one.extra.end() ? "" : sequence->second);
    const bool again =
        pair && std::any_of(pairs.begin(), pairs.end(),
                            [&pair](const ReferencePair& other) {
                              return other.map_id == pair->map_id;
                            });
    if (pair && !again) pairs.push_back(*std::move(pair));
  }
  if (pairs.empty()) return TooFew(0, count);
  return ReferencePool::Create(std::move(pairs));
}

}  // namespace terra::benchmark
