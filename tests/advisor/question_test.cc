// What a model is asked: which parts are there, which are not, and what noise
// reaches. The wording itself is held by the hash in llm_backend_test.cc.
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "advisor/descriptions.h"
#include "advisor/llm_methods.h"
#include "advisor/pictures.h"
#include "terrain/builtin_legends.h"
#include "terrain/route_cost.h"

namespace terra::advisor {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

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

TEST(Question, SaysWhichCellAPixelShows) {
  const auto text = [](int width, int height, bool axes) {
    return PixelText(ChooseFrame(width, height, axes), "image 1");
  };
  EXPECT_EQ(text(500, 500, false), "In image 1 one pixel is one cell.\n");
  EXPECT_THAT(text(500, 500, true),
              HasSubstr("x = (u - 32) / 2, y = (v - 14) / 2, both rounded"));
  EXPECT_THAT(text(1'000, 900, true), HasSubstr("x = u - 32, y = v - 14."));
  EXPECT_THAT(text(3'200, 400, false), HasSubstr("x = 3 * u, y = 3 * v."));
  EXPECT_THAT(text(3'200, 400, true),
              HasSubstr("x = 3 * (u - 32), y = 3 * (v - 14)."));
}

}  // namespace
}  // namespace terra::advisor
