// LCM URLs: every process reads them alike, and liblcm as we do.
#include "bus/lcm_url.h"

#include <poll.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include "bus/advice_receiver.h"
#include "bus/bus.h"
#include "bus/lcm_link.h"
#include "bus/process.h"
#include "tests/support/random_map.h"
#include "tests/support/test_bus.h"

namespace terra::bus {
namespace {

using terra::testing::Random;

struct Read {
  std::string url;
  std::string text;  // In full; empty = refused.
};

TEST(LcmUrlTest, IsReadInFull) {
  for (const auto& [url, text] : std::vector<Read>{
           {"udpm://", "udpm://239.255.76.67:7667"},
           {"udpm://239.255.76.67", "udpm://239.255.76.67:7667"},
           {"udpm://239.255.76.67?ttl=0", "udpm://239.255.76.67:7667?ttl=0"},
           {"udpm://:7700", "udpm://239.255.76.67:7700"},
           {"udpm://224.1.2.3:1?ttl=255", "udpm://224.1.2.3:1?ttl=255"},
           {"udpm://239.255.76.67:7667?", "udpm://239.255.76.67:7667"},
           {"udpm://239.255.76.67:7667?other=1",
            "udpm://239.255.76.67:7667?other=1"},
           {"tcpq://", "tcpq://127.0.0.1:7700"},
           {"tcpq://hub.example:1234", "tcpq://hub.example:1234"},
           {"memq://", "memq://"},
           {"file:///a b.log?speed=0", "file:///a b.log?speed=0"}}) {
    const Result<LcmUrl> parsed = ParseLcmUrl(url);
    ASSERT_TRUE(parsed.ok()) << parsed.error().message;
    EXPECT_EQ(parsed->text(), text) << url;
  }
}

// What liblcm would read otherwise (07667 is octal to it, "abc" is ttl 1) or
// not at all.
TEST(LcmUrlTest, IsRefusedWhereLcmWouldReadItOtherwise) {
  for (const std::string url : {"",
                                "239.255.76.67:7667",
                                "://x",
                                "udpm://239.255.76.67:",
                                "udpm://239.255.76.67:0",
                                "udpm://239.255.76.67:07667",
                                "udpm://239.255.76.67:0x1df3",
                                "udpm://239.255.76.67:7667x",
                                "udpm://239.255.76.67:+7667",
                                "udpm://239.255.76.67: 7667",
                                "udpm://239.255.76.67:70000",
                                "udpm://239.255.76.67:7667/",
                                "udpm://10.0.0.1:7667",
                                "udpm://239.255.76:7667",
                                "udpm://host:7667",
                                "udpm://239.255.76.67:7667?ttl=abc",
                                "udpm://239.255.76.67?ttl=256",
                                "udpm://239.255.76.67:7667?ttl=-1",
                                "udpm://239.255.76.67?ttl=",
                                "udpm://239.255.76.67?ttl=0&recv_buf_size=2MB",
                                "udpm://239.255.76.67?ttl=0,recv_buf_size=0",
                                "udpm://239.255.76.67?recv_buf_size=010",
                                "tcpq://127.0.0.1:0",
                                "tcpq://127.0.0.1:x",
                                "udpm://239.255.76.67\n:7667"}) {
    const Result<LcmUrl> parsed = ParseLcmUrl(url);
    EXPECT_FALSE(parsed.ok()) << url;
  }
  const std::string with_zero("udpm://239.255.76.67\0:7667", 26);
  EXPECT_FALSE(ParseLcmUrl(with_zero).ok());
}

TEST(LcmUrlTest, TheLastOfAnOptionCounts) {
  const std::string url = "udpm://239.255.76.67:7667?recv_buf_size=";
  EXPECT_EQ(ParseLcmUrl(url + "1000&recv_buf_size=2000")->recv_buf_size, 2'000);
  EXPECT_EQ(ParseLcmUrl(url + "1000,ttl=0")->recv_buf_size, 1'000);
  EXPECT_EQ(ParseLcmUrl(url + "1000&xrecv_buf_size=3")->recv_buf_size, 1'000);
}

TEST(LcmUrlTest, OneBusHasManyNames) {
  const auto same = [](const char* a, const char* b) {
    return SameBus(*ParseLcmUrl(a), *ParseLcmUrl(b));
  };
  EXPECT_TRUE(same("udpm://", "udpm://239.255.76.67:7667?ttl=0"));
  EXPECT_TRUE(same("udpm://:7700?ttl=1", "udpm://239.255.76.67:7700"));
  EXPECT_FALSE(same("udpm://:7700", "udpm://:7701"));
  EXPECT_FALSE(same("udpm://:7700", "tcpq://:7700"));
  EXPECT_FALSE(same("udpm://224.0.0.9:7700", "udpm://:7700"));
  EXPECT_TRUE(same("memq://", "memq://"));
  EXPECT_FALSE(same("file://a", "file://b"));
}

TEST(BusOptionsTest, AnAdviceBusInAnotherSpellingIsTheSameBus) {
  BusOptions options;
  options.lcm_url = "udpm://239.255.76.67:7667?ttl=0";
  options.advice_url = "udpm://239.255.76.67?ttl=0";
  ASSERT_TRUE(options.Complete().ok());
  EXPECT_TRUE(options.OneBus());
  options.advice_url = "udpm://:7668";
  ASSERT_TRUE(options.Complete().ok());
  EXPECT_FALSE(options.OneBus());
}

TEST(BusOptionsTest, TheJournalHasAPortOfItsOwnWhereThereAreTwoBuses) {
  BusOptions options;
  options.lcm_url = "udpm://:7700";
  ASSERT_TRUE(options.Complete().ok());
  EXPECT_EQ(*options.JournalUrl(), "udpm://239.255.76.67:7702");
  options.advice_url = "udpm://:7702";
  ASSERT_TRUE(options.Complete().ok());
  const auto taken = options.JournalUrl();
  ASSERT_FALSE(taken.ok());
  EXPECT_NE(taken.error().message.find("choose another port"),
            std::string::npos);
  options.advice_url = options.lcm_url;
  ASSERT_TRUE(options.Complete().ok());
  EXPECT_EQ(*options.JournalUrl(), options.lcm_url);
}

TEST(BusOptionsTest, OnlyAnUdpmBusCanBeApartFromTheDeployedOne) {
  BusOptions options;
  options.lcm_url = "tcpq://127.0.0.1:7700";
  options.advice_url = "tcpq://127.0.0.1:7701";
  const Status completed = options.Complete();
  ASSERT_FALSE(completed.ok());
  EXPECT_NE(completed.error().message.find("leave --advice-url out"),
            std::string::npos);
  options.advice_url.clear();
  ASSERT_TRUE(options.Complete().ok());
  EXPECT_TRUE(options.OneBus());
}

TEST(BusOptionsTest, ABusThatReachesNoOtherProcessIsNoticed) {
  for (const char* url : {"memq://", "memq://name", "file:///tmp/a.log"}) {
    BusOptions options;
    options.lcm_url = url;
    ASSERT_TRUE(options.Complete().ok());
    EXPECT_NE(options.Notice().find("no other process is heard"),
              std::string::npos)
        << url;
  }
  for (const char* url : {"udpm://", "tcpq://"}) {
    BusOptions options;
    options.lcm_url = url;
    ASSERT_TRUE(options.Complete().ok());
    EXPECT_EQ(options.Notice(), "") << url;
  }
}

// A URL of parts, each of which may be left out or wrong.
std::string AnyUrl(Random& random) {
  const auto one_of = [&random](const std::vector<std::string>& parts) {
    return parts[static_cast<std::size_t>(
        random.Int(0, static_cast<int>(parts.size()) - 1))];
  };
  std::string url = "udpm://" +
                    one_of({"", "239.255.76.67", "224.0.1.9", "239.1.2.3",
                            "10.0.0.1", "239.255.76"}) +
                    one_of({"", "", ":7667", ":7668", ":20011", ":65535", ":0",
                            ":", ":020011", ":0x4e2b", ":20011x"});
  for (int i = random.Int(0, 3); i > 0; --i) {
    url += url.find('?') == std::string::npos ? "?" : one_of({"&", ","});
    url += one_of({"ttl=0", "recv_buf_size=100000", "ttl=0", "ttl=00",
                   "recv_buf_size=1e6", "other"});
  }
  return url;
}

TEST(LcmUrlTest, ReadingWhatWasReadChangesNothing) {
  Random random(3);
  for (int i = 0; i < 20'000; ++i) {
    const std::string url = AnyUrl(random);
    const Result<LcmUrl> parsed = ParseLcmUrl(url);
    if (!parsed) continue;
    const Result<LcmUrl> again = ParseLcmUrl(parsed->text());
    ASSERT_TRUE(again.ok()) << url;
    EXPECT_EQ(again->text(), parsed->text()) << url;
    EXPECT_TRUE(SameBus(*parsed, *again)) << url;
    EXPECT_EQ(again->recv_buf_size, parsed->recv_buf_size) << url;
  }
}

// ---- What liblcm makes of it. ----

// Whether a datagram of a channel comes within 2 s.
bool Hears(AdviceReceiver& receiver) {
  pollfd waited{receiver.fd(), POLLIN, 0};
  bool heard = false;
  while (!heard && poll(&waited, 1, 2'000) == 1) {
    receiver.Drain(1, 16, [&heard](const LcmDatagram&, SenderAddress) {
      heard = true;
    });
  }
  return heard;
}

bool Carries(LcmLink& link, const std::string& url) {
  Result<AdviceReceiver> receiver = AdviceReceiver::Open(url, "A");
  if (!receiver) return false;
  const std::vector<std::uint8_t> bytes = {1, 2, 3};
  return link.Publish("A", bytes) && Hears(*receiver);
}

// Sent by liblcm, heard by the receiver of our own: both read the URL alike,
// or both refuse it.
TEST(LcmUrlTest, SenderAndReceiverAgreeOnEveryUrl) {
  const terra::testing::TestBus bus;
  if (!bus.in_own_namespace()) {
    GTEST_SKIP() << "needs a network of its own, to use LCM's default port";
  }
  Random random(5);
  int carried = 0;
  int refused = 0;
  for (int i = 0; i < 150; ++i) {
    const std::string url = AnyUrl(random);
    Result<std::unique_ptr<LcmLink>> link = LcmLink::Open(url);
    EXPECT_EQ(AdviceReceiver::Open(url, "A").ok(), link.ok()) << url;
    BusOptions options;
    options.lcm_url = "udpm://239.255.76.67:4000?ttl=0";
    options.advice_url = url;
    EXPECT_EQ(options.Complete().ok(), link.ok()) << url;
    if (link) {
      EXPECT_TRUE(Carries(**link, url)) << url;
      EXPECT_TRUE(Carries(**link, ParseLcmUrl(url)->text())) << url;
    }
    ++(link ? carried : refused);
  }
  EXPECT_GT(carried, 20);
  EXPECT_GT(refused, 20);
}

// What is given in full is what liblcm itself reads there.
TEST(LcmUrlTest, WhatIsGivenInFullIsWhatLcmReads) {
  const terra::testing::TestBus bus;
  for (const char* options :
       {"", "?ttl=0", "?ttl=0&recv_buf_size=100000", "?ttl=0,other=1"}) {
    const std::string url =
        "udpm://239.255.76.67:" + std::to_string(bus.port()) + options;
    if (std::string(options).empty() && !bus.in_own_namespace()) continue;
    Result<AdviceReceiver> receiver = AdviceReceiver::Open(url, "A");
    ASSERT_TRUE(receiver.ok()) << receiver.error().message;
    lcm_t* lcm = lcm_create(url.c_str());
    ASSERT_NE(lcm, nullptr) << url;
    EXPECT_EQ(lcm_publish(lcm, "A", "x", 1), 0) << url;
    EXPECT_TRUE(Hears(*receiver)) << url;
    lcm_destroy(lcm);
  }
}

}  // namespace
}  // namespace terra::bus
