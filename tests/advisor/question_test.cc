// What a model is asked: which parts are there, which are not, and what noise
// reaches. The wording itself is held by the hash in llm_backend_test.cc.
#include <cmath>
#include <memory>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "advisor/llm_methods.h"
#include "advisor/map_noise.h"
#include "advisor/pictures.h"
#include "advisor/terrain_regions.h"
#include "terrain/builtin_legends.h"
#include "terrain/digest.h"
#include "terrain/native_search.h"
#include "terrain/route_cost.h"
#include "terrain/segment.h"
#include "tests/support/random_map.h"

namespace terra::advisor {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::Random;
using testing::RandomMap;
using testing::RandomMapKind;

// Grass with a dear bar across the way, open at the top; a baseline across it
// and another one around it.
struct Problem {
  TerrainMap map = [] {
    ByteRaster ids = ByteRaster::Zero(120, 160);
    ids.block(30, 70, 90, 20).setConstant(10);
    return TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
  }();
  Route across = {{20, 60}, {140, 60}};
  Route around = {{20, 60}, {69, 28}, {91, 28}, {140, 60}};

  PreparedCase Prepare(
      const MethodOptions& options, const Route& baseline,
      const ReferencePool* pool = &ReferencePool::Builtin()) const {
    return PrepareCase({"case", map, baseline.front(), baseline.back(),
                        baseline, WalkRoute(map, baseline).cost, ""},
                       options, pool);
  }
};

std::string HashOf(const PreparedCase& prepared) {
  return RequestHash({"openai", "m", "{}", "provider"}, prepared.request);
}

int BluePixels(const EncodedPicture& picture) {
  const Picture shown = DecodePicture(picture.png).value();
  int count = 0;
  for (std::size_t i = 0; i < shown.rgb.size(); i += 3) {
    count +=
        Color{shown.rgb[i], shown.rgb[i + 1], shown.rgb[i + 2]} == kRouteBlue;
  }
  return count;
}

TEST(Question, ShowsMapBaselineAndReferencePairAndDescribesThem) {
  const Problem problem;
  const PreparedCase prepared = problem.Prepare({}, problem.across);
  const auto& pictures = prepared.request.pictures;
  ASSERT_EQ(pictures.size(), 3u);
  EXPECT_EQ(pictures[0]->width_px, 160);
  EXPECT_EQ(pictures[0]->height_px, 120);
  EXPECT_EQ(BluePixels(*pictures[0]), 0);
  EXPECT_GT(BluePixels(*pictures[1]), 100);
  EXPECT_FALSE(prepared.reference_id.empty());
  const std::string& text = prepared.request.text;
  EXPECT_THAT(text, HasSubstr("Start: (20, 60)\nGoal: (140, 60)\n"));
  for (const Terrain& terrain : problem.map.legend().terrains()) {
    EXPECT_THAT(text, HasSubstr(terrain.name));
  }
  EXPECT_THAT(text, HasSubstr("Total cost of the baseline: "));
  EXPECT_THAT(text, HasSubstr("REFERENCE EXAMPLE"));
  EXPECT_THAT(text, HasSubstr("white edge"));
}

TEST(Question, DescribesEveryFifthCellOfTheBaselineAndTheLast) {
  const Problem problem;
  const Route baseline = {{20, 60}, {32, 60}};
  const std::string text = problem.Prepare({}, baseline).request.text;
  for (const int x : {20, 25, 30, 32}) {
    EXPECT_THAT(text, HasSubstr("(" + std::to_string(x) + ", 60)"));
  }
  for (const int x : {21, 24, 26, 31}) {
    EXPECT_THAT(text, Not(HasSubstr("(" + std::to_string(x) + ", 60)")));
  }
}

TEST(Question, WithoutOverlayAndRouteTextNothingOfTheBaselineIsLeft) {
  const Problem problem;
  MethodOptions options;
  options.prompt.overlay = options.prompt.route_text = false;
  for (const bool more : {false, true}) {
    options.prompt.regions = options.prompt.stretches = more;
    const PreparedCase one = problem.Prepare(options, problem.across);
    const PreparedCase other = problem.Prepare(options, problem.around);
    EXPECT_EQ(HashOf(one), HashOf(other));
    EXPECT_EQ(one.request.pictures.size(), 2u) << "the pair moves up";
  }
}

TEST(Question, EachSwitchTakesItsPartAlone) {
  const Problem problem;
  MethodOptions options;
  options.prompt.rea = false;
  PreparedCase prepared = problem.Prepare(options, problem.across);
  EXPECT_EQ(prepared.request.pictures.size(), 2u);
  EXPECT_THAT(prepared.request.text, Not(HasSubstr("eference")));
  options = {};
  options.prompt.overlay = false;
  prepared = problem.Prepare(options, problem.across);
  EXPECT_EQ(BluePixels(*prepared.request.pictures[0]), 0);
  EXPECT_THAT(prepared.request.text, Not(HasSubstr("baseline shown")));
  EXPECT_THAT(prepared.request.text, HasSubstr("Total cost of the baseline"));
  options = {};
  options.prompt.route_text = false;
  prepared = problem.Prepare(options, problem.across);
  EXPECT_EQ(prepared.request.pictures.size(), 3u);
  EXPECT_THAT(prepared.request.text, Not(HasSubstr("Total cost")));
}

TEST(Question, DirectAndLlmAstarSeeOnePictureAndNoBaseline) {
  const Problem problem;
  for (const Method method : {Method::kDirect, Method::kLlmAstar}) {
    MethodOptions options;
    options.method = method;
    const PreparedCase one = problem.Prepare(options, problem.across);
    EXPECT_EQ(one.request.pictures.size(), 1u);
    EXPECT_EQ(HashOf(one), HashOf(problem.Prepare(options, problem.around)));
    EXPECT_THAT(one.request.text, Not(HasSubstr("aseline")));
    EXPECT_THAT(one.request.text, Not(HasSubstr("Yes")));
    EXPECT_TRUE(one.reference_id.empty());
  }
}

TEST(Question, NoiseReachesTheShownMapAndNothingElse) {
  const Problem problem;
  MethodOptions noisy;
  noisy.noise_percent = 10;
  const PreparedCase clean = problem.Prepare({}, problem.across);
  const PreparedCase prepared = problem.Prepare(noisy, problem.across);
  EXPECT_NE(prepared.request.pictures[0]->pixel_hash,
            clean.request.pictures[0]->pixel_hash);
  EXPECT_EQ(prepared.request.pictures[2]->pixel_hash,
            clean.request.pictures[2]->pixel_hash);
  const auto section = [](const PreparedCase& of, const char* from,
                          const char* to) {
    const std::string& text = of.request.text;
    return text.substr(text.find(from), text.find(to) - text.find(from));
  };
  EXPECT_NE(section(prepared, "\nTERRAIN\n", "\nBASELINE\n"),
            section(clean, "\nTERRAIN\n", "\nBASELINE\n"));
  EXPECT_EQ(section(prepared, "\nBASELINE\n", "\nREFERENCE"),
            section(clean, "\nBASELINE\n", "\nREFERENCE"));
}

TEST(Question, AnOtherLegendHasNoReferenceUnlessItsPoolIsGiven) {
  const ByteRaster ids = ByteRaster::Zero(20, 20);
  const TerrainMap map = TerrainMap::Create(ids, RugdLegend()).value();
  const Route route = {{1, 1}, {18, 18}};
  const PreparedCase prepared =
      PrepareCase({"case", map, route.front(), route.back(), route, 1, ""}, {},
                  &ReferencePool::Builtin());
  EXPECT_TRUE(prepared.reference_missing);
  EXPECT_EQ(prepared.request.pictures.size(), 2u);
}

TEST(Question, AMapTooLargeToShowIsReducedAndTheTextSaysHow) {
  const TerrainMap map =
      TerrainMap::Create(ByteRaster::Zero(400, 3'200), MultiTerraPathLegend())
          .value();
  const Route route = {{10, 10}, {3'000, 300}};
  const PreparedCase prepared = PrepareCase(
      {"case", map, route.front(), route.back(), route, 1, ""}, {}, nullptr);
  EXPECT_EQ(prepared.request.pictures[0]->width_px, 1'067);
  EXPECT_THAT(prepared.request.text, HasSubstr("3 x 3 cells"));
}

TEST(Pictures, ShowEachCellInItsTerrainsColour) {
  Random random(3);
  const TerrainMap map = RandomMap(random, 60, 50, RandomMapKind::kNoise);
  const Picture picture =
      DrawMap(map, ChooseFrame(60, 50, false), {0, 0}, {59, 49});
  for (int y = 15; y < 35; ++y) {  // Away from the markers.
    for (int x = 0; x < 60; ++x) {
      const std::uint8_t* rgb =
          &picture.rgb[static_cast<std::size_t>(3 * (y * 60 + x))];
      const Terrain* terrain = map.legend().Find(map.ids()(y, x));
      ASSERT_NE(terrain, nullptr);
      EXPECT_EQ((Color{rgb[0], rgb[1], rgb[2]}), terrain->color);
    }
  }
}

TEST(Pictures, SurviveTheirEncoding) {
  Random random(5);
  const TerrainMap map = RandomMap(random, 70, 40, RandomMapKind::kRectangles);
  const Route route = {{2, 2}, {60, 30}};
  const Picture picture = DrawMap(map, ChooseFrame(70, 40, true), route.front(),
                                  route.back(), &route);
  const EncodedPicture encoded = EncodePicture(picture);
  EXPECT_EQ(DecodePicture(encoded.png).value(), picture);
  EXPECT_EQ(encoded.pixel_hash, PixelHash(picture));
  EXPECT_FALSE(DecodePicture("no picture"));
  EXPECT_FALSE(DecodePicture(encoded.png.substr(0, 40)));
}

TEST(Pictures, AReducedMapShowsTheDearestOfEachBlock) {
  ByteRaster ids = ByteRaster::Zero(1'600, 1'600);
  ids(801, 801) = 11;  // One obstacle in a block of four.
  const TerrainMap map =
      TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
  const Picture picture =
      DrawMap(map, ChooseFrame(1'600, 1'600, false), {0, 0}, {1, 1});
  ASSERT_EQ(picture.width, 800);
  const std::uint8_t* rgb =
      &picture.rgb[static_cast<std::size_t>(3 * (400 * 800 + 400))];
  EXPECT_EQ((Color{rgb[0], rgb[1], rgb[2]}), map.legend().Find(11)->color);
}

// The oracle: a flood fill from each cell not yet seen.
std::multiset<std::int64_t> RegionSizes(const TerrainMap& map) {
  std::multiset<std::int64_t> sizes;
  ByteRaster seen = ByteRaster::Zero(map.height(), map.width());
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (seen(y, x) != 0) continue;
      std::int64_t size = 0;
      std::vector<Cell> open = {{x, y}};
      seen(y, x) = 1;
      while (!open.empty()) {
        const Cell at = open.back();
        open.pop_back();
        ++size;
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const Cell to{at.x + dx, at.y + dy};
            if (!map.Contains(to) || seen(to.y, to.x) != 0 ||
                map.Cost(to) != map.Cost(at)) {
              continue;
            }
            seen(to.y, to.x) = 1;
            open.push_back(to);
          }
        }
      }
      sizes.insert(size);
    }
  }
  return sizes;
}

TEST(Regions, AreThoseOfAFloodFill) {
  Random random(9);
  for (int round = 0; round < 60; ++round) {
    const auto kind =
        round % 2 == 0 ? RandomMapKind::kNoise : RandomMapKind::kRectangles;
    const TerrainMap map =
        RandomMap(random, random.Int(1, 40), random.Int(1, 40), kind);
    const TerrainRegions found = FindRegions(map, 0, 1'000'000);
    std::multiset<std::int64_t> sizes;
    for (const TerrainRegion& region : found.large) {
      sizes.insert(region.cells);
      EXPECT_EQ(map.Cost(region.inside), region.cost);
      EXPECT_TRUE(
          region.inside.x >= region.low.x && region.inside.x <= region.high.x &&
          region.inside.y >= region.low.y && region.inside.y <= region.high.y);
    }
    EXPECT_EQ(sizes, RegionSizes(map));
  }
}

TEST(Regions, SmallOnesAndThoseBeyondTheLimitAreSummedUp) {
  Random random(10);
  const TerrainMap map = RandomMap(random, 60, 60, RandomMapKind::kRectangles);
  const TerrainRegions all = FindRegions(map, 0, 1'000'000);
  const TerrainRegions few = FindRegions(map, 20, 3);
  ASSERT_EQ(few.large.size(), 3u);
  std::int64_t cells = few.small_cells;
  for (const TerrainRegion& region : few.large) {
    EXPECT_GT(region.cells, 20);
    cells += region.cells;
  }
  EXPECT_EQ(cells, 60 * 60);
  EXPECT_EQ(few.small_regions + 3, static_cast<int>(all.large.size()));
}

int Differing(const TerrainMap& a, const TerrainMap& b) {
  int count = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      count += a.ids()(y, x) != b.ids()(y, x);
    }
  }
  return count;
}

TEST(Noise, ChangesTheShareAskedForAwayFromTheEnds) {
  Random random(12);
  const TerrainMap map =
      RandomMap(random, 300, 300, RandomMapKind::kRectangles);
  const NoiseOptions options{10, 7, "case", {20, 20}, {280, 280}};
  const TerrainMap noisy = WithNoise(map, options);
  const int changed = Differing(map, noisy);
  EXPECT_GE(changed, 9'000);
  EXPECT_LE(changed, 9'000 + kMaxPatchSide * kMaxPatchSide);
  for (const Cell end : {options.start, options.goal}) {
    for (int dy = -kNoiseFreeCells; dy <= kNoiseFreeCells; ++dy) {
      for (int dx = -kNoiseFreeCells; dx <= kNoiseFreeCells; ++dx) {
        EXPECT_EQ(map.ids()(end.y + dy, end.x + dx),
                  noisy.ids()(end.y + dy, end.x + dx));
      }
    }
  }
  EXPECT_EQ(MapId(noisy), MapId(WithNoise(map, options)));
  NoiseOptions other = options;
  other.case_id = "other";
  EXPECT_NE(MapId(noisy), MapId(WithNoise(map, other)));
}

TEST(Noise, LessNoiseIsTheBeginningOfMore) {
  Random random(13);
  const TerrainMap map =
      RandomMap(random, 300, 300, RandomMapKind::kRectangles);
  const TerrainMap five = WithNoise(map, {5, 7, "case", {20, 20}, {280, 280}});
  const TerrainMap ten = WithNoise(map, {10, 7, "case", {20, 20}, {280, 280}});
  EXPECT_LE(Differing(five, ten),
            9'000 - 4'500 + 2 * kMaxPatchSide * kMaxPatchSide);
}

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
