#include "bus/subscribers.h"

#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "bus/udpm_receiver.h"
#include "tests/support/test_bus.h"

namespace terra::bus {
namespace {

TEST(SubscribersTest, CountsTheSocketsOfOnePort) {
  std::istringstream table(
      "   sl  local_address rem_address   st tx_queue rx_queue tr tm->when\n"
      "  298: 434CFFEF:1DF3 00000000:0000 07 00000000:00000000 00:00000000\n"
      "  298: 00000000:1DF3 00000000:0000 07 00000000:00000000 00:00000000\n"
      "  299: 434CFFEF:1DF4 00000000:1DF3 07 00000000:00000000 00:00000000\n"
      "damaged\n");
  EXPECT_EQ(CountUdpSockets(table, 7667), 2);
  std::istringstream nothing;
  EXPECT_EQ(CountUdpSockets(nothing, 7667), 0);
}

TEST(SubscribersTest, SeesWhoListens) {
  const terra::testing::TestBus bus;
  EXPECT_EQ(CountSubscribers(bus.url()), 0);
  std::vector<Result<UdpmReceiver>> receivers;
  for (int i = 0; i < 3; ++i) {
    receivers.push_back(UdpmReceiver::Open(bus.url()));
    ASSERT_TRUE(receivers.back()) << receivers.back().error().message;
  }
  EXPECT_EQ(CountSubscribers(bus.url()), 3);
  EXPECT_EQ(CountSubscribers(bus.advice_url()), 0);
  EXPECT_EQ(CountSubscribers("memq://"), 0);
}

TEST(SubscribersTest, WarnsFromAHundredOn) {
  EXPECT_EQ(SubscribersWarning(99), "");
  EXPECT_NE(SubscribersWarning(100).find("100 sockets"), std::string::npos);
}

}  // namespace
}  // namespace terra::bus
