#include "advisor/reference_pool.h"

#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/native_search.h"
#include "terrain/route_cost.h"
#include "terrain/segment.h"

namespace terra::advisor {
namespace {

TEST(References, EveryPairShippedIsClearCutAndFeasible) {
  const ReferencePool& pool = ReferencePool::Builtin();
  EXPECT_GE(pool.pairs().size(), 10u);
  const auto length = [](const Route& route) {
    const CellPath cells = RasterizeRoute(route);
    double sum = 0;
    for (std::size_t i = 1; i < cells.size(); ++i) {
      sum += cells[i].x != cells[i - 1].x && cells[i].y != cells[i - 1].y
                 ? std::sqrt(2.0)
                 : 1.0;
    }
    return sum;
  };
  for (const ReferencePair& pair : pool.pairs()) {
    const double left = WalkRoute(pair.map, pair.left).cost;
    const double right = WalkRoute(pair.map, pair.right).cost;
    EXPECT_TRUE(std::isfinite(left) && std::isfinite(right));
    EXPECT_DOUBLE_EQ(left, pair.costs.left);
    EXPECT_DOUBLE_EQ(right, pair.costs.right);
    EXPECT_GE(right, kMinCostRatio * left);
    EXPECT_GE(length(pair.left), kMinLengthRatio * length(pair.right));
    EXPECT_NEAR(
        left, NativeSearch(pair.map, pair.left.front(), pair.left.back()).cost,
        1e-6 * left);
  }
}

TEST(References, TheCasesOwnMapIsNeverShown) {
  const ReferencePool& pool = ReferencePool::Builtin();
  for (const ReferencePair& own : pool.pairs()) {
    for (int i = 0; i < 50; ++i) {
      const ReferencePair* chosen = pool.Choose(
          0, "case " + std::to_string(i), pool.legend(), {own.map_id, ""});
      ASSERT_NE(chosen, nullptr);
      EXPECT_NE(chosen->map_id, own.map_id);
    }
  }
}

TEST(References, TheChoiceFollowsSeedAndCaseAlone) {
  const ReferencePool& pool = ReferencePool::Builtin();
  std::set<std::int64_t> chosen;
  for (int i = 0; i < 200; ++i) {
    const std::string id = std::to_string(i);
    const ReferencePair* pair = pool.Choose(1, id, pool.legend(), {});
    EXPECT_EQ(pair, pool.Choose(1, id, pool.legend(), {}));
    chosen.insert(pair->map_id);
  }
  EXPECT_EQ(chosen.size(), pool.pairs().size());
}

TEST(References, APoolIsReadBackAsItWasWritten) {
  const std::vector<ReferencePair>& all = ReferencePool::Builtin().pairs();
  const auto pool = ReferencePool::Create({all[0], all[1]});
  ASSERT_TRUE(pool.ok());
  const auto read = ReferencePool::Parse(pool->Serialize());
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->id(), pool->id());
  EXPECT_FALSE(ReferencePool::Parse("").ok());
  EXPECT_FALSE(ReferencePool::Parse("{}\n{}\n").ok());
}

}  // namespace
}  // namespace terra::advisor
