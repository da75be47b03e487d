#include "terrain/route_text.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace terra {
namespace {

using ::testing::HasSubstr;

TEST(RouteTextTest, RoundTrip) {
  const Route route = {{0, 0}, {-3, 12}, {499, 250}};
  EXPECT_EQ(FormatRoute(route), "[(0, 0), (-3, 12), (499, 250)]");
  EXPECT_EQ(ParseRoute(FormatRoute(route)).value(), route);
  EXPECT_EQ(ParseRoute(" [( 1,2 ),\n(3,4)] ").value(), (Route{{1, 2}, {3, 4}}));
  EXPECT_TRUE(ParseRoute("[]").value().empty());
}

TEST(RouteTextTest, ErrorsNameThePosition) {
  for (const std::string text :
       {"", "(1,2)", "[(1,2]", "[(1,2),]", "[(1.5,2)]", "[(1,2)] x",
        "[(1234567890,2)]", "[(,2)]", "[(--1,2)]"}) {
    const auto route = ParseRoute(text);
    ASSERT_FALSE(route.ok()) << text;
    EXPECT_THAT(route.error().message, HasSubstr("position"));
  }
}

TEST(RouteTextTest, WaypointLimit) {
  EXPECT_TRUE(ParseRoute("[(1,2), (3,4)]", 2).ok());
  EXPECT_FALSE(ParseRoute("[(1,2), (3,4), (5,6)]", 2).ok());
}

TEST(PointTextTest, ReadsXCommaY) {
  EXPECT_EQ(ParsePoint("33,154").value(), (Cell{33, 154}));
  for (const std::string text : {"33", "33,", ",4", "3;4", "3,4,5", "a,b"}) {
    EXPECT_FALSE(ParsePoint(text).ok()) << text;
  }
}

}  // namespace
}  // namespace terra
