#include <cstdlib>

#include <gtest/gtest.h>

#include "bus/channels.h"
#include "bus/lcm_url.h"

namespace terra::bus {
namespace {

TEST(ChannelNamesTest, RobotGoesInFrontOfEveryName) {
  const Result<ChannelNames> names = ChannelNames::Create("R2", "");
  ASSERT_TRUE(names.ok());
  EXPECT_EQ(names->name(Channel::kBaseline), "R2_TERRA_BASELINE");
  EXPECT_EQ(names->name(Channel::kMapTile), "R2_TERRA_MAP_TILE");
}

TEST(ChannelNamesTest, MapPrefixLetsRobotsShareAMapServer) {
  const Result<ChannelNames> names = ChannelNames::Create("R2", "SITE");
  ASSERT_TRUE(names.ok());
  EXPECT_EQ(names->name(Channel::kBaseline), "R2_TERRA_BASELINE");
  EXPECT_EQ(names->name(Channel::kMapHeader), "SITE_TERRA_MAP_HEADER");
}

TEST(ChannelNamesTest, PrefixesOf32CharactersAreTakenAndNoMore) {
  EXPECT_TRUE(ChannelNames::Create(std::string(32, 'A'), "").ok());
  EXPECT_FALSE(ChannelNames::Create(std::string(33, 'A'), "").ok());
  EXPECT_FALSE(ChannelNames::Create("r2", "").ok());
  EXPECT_FALSE(ChannelNames::Create("", ".*").ok());
}

TEST(ChannelNamesTest, FindsTheChannelOfAName) {
  const Result<ChannelNames> names = ChannelNames::Create("R2", "");
  ASSERT_TRUE(names.ok());
  EXPECT_EQ(names->Find("R2_TERRA_POSE"), Channel::kPose);
  EXPECT_EQ(names->Find("TERRA_POSE"), std::nullopt);
}

TEST(LcmUrlTest, AdviceGoesToTheNextPort) {
  EXPECT_EQ(*AdviceUrlFor("udpm://239.255.76.67:7667?ttl=0"),
            "udpm://239.255.76.67:7668?ttl=0");
  EXPECT_EQ(*AdviceUrlFor("udpm://"), "udpm://239.255.76.67:7668");
  EXPECT_EQ(*AdviceUrlFor("memq://"), "memq://");
  EXPECT_FALSE(AdviceUrlFor("udpm://239.255.76.67:65535").ok());
}

TEST(LcmUrlTest, TheJournalGoesToThePortAfterThat) {
  EXPECT_EQ(*JournalUrlFor("udpm://239.255.76.67:7667?ttl=0"),
            "udpm://239.255.76.67:7669?ttl=0");
  EXPECT_EQ(*JournalUrlFor("udpm://:65533"), "udpm://239.255.76.67:65535");
  EXPECT_EQ(*JournalUrlFor("memq://"), "memq://");
  EXPECT_FALSE(JournalUrlFor("udpm://239.255.76.67:65534").ok());
  EXPECT_FALSE(JournalUrlFor("no url").ok());
}

TEST(LcmUrlTest, RefusesWhatLcmWouldMisread) {
  EXPECT_FALSE(ParseLcmUrl("239.255.76.67:7667").ok());
  EXPECT_FALSE(ParseLcmUrl("udpm://10.0.0.1:7667").ok());
  EXPECT_FALSE(ParseLcmUrl("udpm://239.255.76.67:0").ok());
  EXPECT_FALSE(ParseLcmUrl("udpm://239.255.76.67:70000").ok());
  EXPECT_FALSE(ParseLcmUrl("udpm://239.255.76.67:76x").ok());
}

}  // namespace
}  // namespace terra::bus
