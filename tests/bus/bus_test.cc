#include "bus/bus.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <sys/socket.h>

#include "bus/envelope.h"
#include "bus/event_loop.h"
#include "bus/heartbeat.h"
#include "tests/filled_messages.h"
#include "tests/support/test_bus.h"

namespace terra::bus {
namespace {

using std::chrono::milliseconds;

// Returns the next message, waiting for its event at most 5 s.
std::optional<RawMessage> Next(Inbox& inbox) {
  for (int i = 0; i < 50; ++i) {
    if (std::optional<RawMessage> message = inbox.Pop()) return message;
    pollfd fd{inbox.fd(), POLLIN, 0};
    poll(&fd, 1, 100);
    inbox.Clear();
  }
  return std::nullopt;
}

std::unique_ptr<Bus> OpenBus(const std::string& url) {
  Result<std::unique_ptr<Bus>> bus = Bus::Open(url, ChannelNames());
  if (!bus) ADD_FAILURE() << bus.error().message;
  return *std::move(bus);
}

class BusTest : public ::testing::TestWithParam<std::string> {
 protected:
  std::string url() const {
    return GetParam() == "memq" ? "memq://" : udpm_.url();
  }

 private:
  testing::TestBus udpm_;
};

TEST_P(BusTest, CarriesAMessageUnchanged) {
  const std::vector<Channel> channels = {Channel::kPose, Channel::kBaseline};
  Inbox inbox;
  const auto bus = OpenBus(url());
  ASSERT_TRUE(bus->Listen(channels, inbox).ok());
  Outbox out(*bus, 7);
  auto sent = testing::FilledMessage<terra_msg::baseline_t>();
  ASSERT_TRUE(out.Send(sent));
  const std::optional<RawMessage> got = Next(inbox);
  ASSERT_TRUE(got.has_value());
  EXPECT_EQ(got->channel, Channel::kBaseline);
  EXPECT_EQ(got->bytes, Encode(sent));
}

TEST_P(BusTest, RefusesMessagesAboveTheLimit) {
  const auto bus = OpenBus(url());
  EXPECT_TRUE(
      bus->Publish(Channel::kLog, std::vector<std::uint8_t>(kMaxMessageBytes)));
  EXPECT_FALSE(bus->Publish(Channel::kLog,
                            std::vector<std::uint8_t>(kMaxMessageBytes + 1)));
  EXPECT_EQ(bus->counters().send_failed, 1);
}

TEST_P(BusTest, KeepsTheOrderOfABurst) {
  const std::vector<Channel> channels = {Channel::kPose};
  Inbox inbox;
  const auto bus = OpenBus(url());
  ASSERT_TRUE(bus->Listen(channels, inbox).ok());
  Outbox out(*bus, 7);
  for (int i = 0; i < 100; ++i) {
    auto pose = testing::FilledMessage<terra_msg::pose_t>();
    out.Send(pose);
  }
  for (std::int64_t seq = 1; seq <= 100; ++seq) {
    const std::optional<RawMessage> got = Next(inbox);
    ASSERT_TRUE(got.has_value()) << seq;
    EXPECT_EQ(Decode<terra_msg::pose_t>(got->bytes)->seq, seq);
  }
}

// What is sent over memq:// LCM hands from thread to thread under a mutex of
// GLib's, a futex that ThreadSanitizer cannot see: once in some hundred runs it
// reports a race there. No process uses that provider with two threads.
const std::vector<std::string> kProviders = {
#ifndef __SANITIZE_THREAD__
    "memq",
#endif
    "udpm"};

INSTANTIATE_TEST_SUITE_P(Providers, BusTest, ::testing::ValuesIn(kProviders),
                         [](const auto& tested) {
                           return tested.param;
                         });

void SendRaw(int port, const std::vector<std::uint8_t>& datagram) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const unsigned char ttl = 0;
  setsockopt(fd, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  inet_pton(AF_INET, "239.255.76.67", &to.sin_addr);
  EXPECT_EQ(sendto(fd, datagram.data(), datagram.size(), 0,
                   reinterpret_cast<const sockaddr*>(&to), sizeof to),
            static_cast<ssize_t>(datagram.size()));
  close(fd);
}

// A fragment of a message: number `index` of two, at `offset`.
std::vector<std::uint8_t> Fragment(std::uint16_t index, std::uint32_t offset) {
  std::vector<std::uint8_t> bytes;
  const auto append = [&bytes](std::uint32_t value, int num_bytes) {
    for (int i = num_bytes - 1; i >= 0; --i) {
      bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }
  };
  append(0x4c433033, 4);  // "LC03"
  append(77, 4);          // The message's number.
  append(1'000, 4);       // Its size.
  append(offset, 4);
  append(index, 2);
  append(2, 2);
  const std::string name = index == 0 ? std::string("TERRA_POSE") + '\0' : "";
  bytes.insert(bytes.end(), name.begin(), name.end());
  bytes.resize(bytes.size() + 400, 0xab);
  return bytes;
}

// liblcm writes the second fragment to where its offset says, modulo 2^32: in
// front of the message's memory. Processes that read with it end.
TEST(BusDatagramTest, NoFragmentEndsTheProcess) {
  const std::vector<Channel> channels = {Channel::kPose};
  Inbox inbox;
  const testing::TestBus test_bus;
  const auto bus = OpenBus(test_bus.url());
  ASSERT_TRUE(bus->Listen(channels, inbox).ok());
  for (int i = 0; i < 20; ++i) {
    SendRaw(test_bus.port(), Fragment(0, 0));
    SendRaw(test_bus.port(), Fragment(1, 0xffffff00));
  }
  SendRaw(test_bus.port(), {'L', 'C', '0', '2'});
  Outbox out(*bus, 7);
  auto pose = testing::FilledMessage<terra_msg::pose_t>();
  ASSERT_TRUE(out.Send(pose));
  ASSERT_TRUE(Next(inbox).has_value());
  // A batch is counted when all of it was handed over.
  for (int i = 0; i < 500 && bus->counters().fragments < 40; ++i) {
    std::this_thread::sleep_for(milliseconds(10));
  }
  EXPECT_EQ(bus->counters().fragments, 40);
  EXPECT_EQ(bus->counters().no_message, 1);
  EXPECT_EQ(bus->counters().received, 1);
}

TEST(BusDatagramTest, ManyThousandPacketsLeaveTheThreadItsEnd) {
  const std::vector<Channel> channels = {Channel::kPose};
  Inbox inbox;
  const testing::TestBus test_bus;
  auto bus = OpenBus(test_bus.url());
  ASSERT_TRUE(bus->Listen(channels, inbox).ok());
  std::atomic<bool> ended = false;
  std::thread flooder([&ended, &test_bus] {
    while (!ended) SendRaw(test_bus.port(), Fragment(1, 0));
  });
  bus.reset();  // Joins the thread that reads.
  ended = true;
  flooder.join();
}

TEST(BusErrorTest, ABusyPortIsNamed) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(17602);
  ASSERT_EQ(bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  const auto bus = OpenBus("udpm://239.255.76.67:17602?ttl=0");
  Inbox inbox;
  const std::vector<Channel> channels = {Channel::kPose};
  const Status listening = bus->Listen(channels, inbox);
  close(fd);
  ASSERT_FALSE(listening.ok());
  EXPECT_NE(listening.error().message.find("17602"), std::string::npos);
  EXPECT_NE(listening.error().message.find("taken"), std::string::npos);
}

TEST(BusErrorTest, AUrlOfNoProviderIsRefused) {
  EXPECT_FALSE(Bus::Open("nonsense", ChannelNames()).ok());
  EXPECT_FALSE(Bus::Open("udpm://1.2.3.4:17600", ChannelNames()).ok());
}

TEST(InboxTest, AFullChannelLosesItsOldestAndLeavesTheOthersAlone) {
  Inbox inbox;
  inbox.Push(Channel::kPose, std::vector<std::uint8_t>{42});
  for (int i = 0; i < 200; ++i) {
    inbox.Push(Channel::kStatus,
               std::vector<std::uint8_t>{static_cast<std::uint8_t>(i)});
  }
  EXPECT_EQ(inbox.dropped(), 200 - 128);
  EXPECT_EQ(inbox.Pop()->channel, Channel::kPose);
  EXPECT_EQ(inbox.Pop()->bytes[0], 200 - 128);
}

TEST(InboxTest, ThreadsMayPushWhileOneTakes) {
  Inbox inbox;
  constexpr int kEach = 2000;
  const auto push = [&](Channel channel) {
    for (int i = 0; i < kEach; ++i) {
      inbox.Push(channel, std::vector<std::uint8_t>(16, 1));
    }
  };
  std::thread a(push, Channel::kPose);
  std::thread b(push, Channel::kStatus);
  std::int64_t taken = 0;
  while (taken + inbox.dropped() < 2 * kEach) {
    if (inbox.Pop()) ++taken;
  }
  a.join();
  b.join();
  EXPECT_FALSE(inbox.Pop().has_value());
}

// Ends when it has seen what it waits for.
class EchoNode : public Node {
 public:
  EchoNode() {
    Listen<terra_msg::pose_t>([this](const auto&, Time) {
      got_pose = true;
    });
  }
  Time Advance(Time now) override {
    ++turns;
    return until_end == kNever ? kNever : std::max(now, until_end);
  }
  std::string state() const override { return "ready"; }
  bool done() const override {
    return got_pose || (until_end != kNever && Clock::now() >= until_end);
  }
  bool got_pose = false;
  Time until_end = kNever;
  int turns = 0;
};

TEST(EventLoopTest, HandsMessagesFromAnotherThreadToTheNode) {
  const StopSignal stop;
  Inbox inbox;
  const testing::TestBus test_bus;
  const auto bus = OpenBus(test_bus.url());
  EchoNode node;
  ASSERT_TRUE(bus->Listen(node.channels(), inbox).ok());
  EventLoop loop(inbox, stop);
  std::thread sender([&] {
    Outbox out(*bus, 7);
    auto pose = testing::FilledMessage<terra_msg::pose_t>();
    out.Send(pose);
  });
  loop.Run(node);
  sender.join();
  EXPECT_TRUE(node.got_pose);
}

TEST(EventLoopTest, EndsOnSigterm) {
  const StopSignal stop;
  Inbox inbox;
  EventLoop loop(inbox, stop);
  EchoNode node;
  std::raise(SIGTERM);
  loop.Run(node);
  EXPECT_FALSE(node.got_pose);
}

TEST(EventLoopTest, RestsWhileNothingHappens) {
  const StopSignal stop;
  Inbox inbox;
  EventLoop loop(inbox, stop);
  EchoNode node;
  node.until_end = Clock::now() + milliseconds(100);
  loop.Run(node);
  EXPECT_LE(node.turns, 5);
}

// In a state of the test's choice.
class StateNode : public Node {
 public:
  Time Advance(Time) override { return kNever; }
  std::string state() const override { return state_now; }
  std::string state_now = "waiting for map";
};

TEST(HeartbeatTest, TellsAChangedStateAtOnceAndElseOnceASecond) {
  const auto bus = OpenBus("memq://");
  Inbox inbox;
  Outbox out(*bus, 7);
  Heartbeat heartbeat("test", "", out, *bus, *bus, inbox);
  StateNode node;
  const auto sent_at = [&](milliseconds at) -> std::int64_t {
    heartbeat.Advance(node, Time(at));
    return bus->counters().sent.load();
  };
  EXPECT_EQ(sent_at(milliseconds(0)), 1) << "the first state";
  EXPECT_EQ(sent_at(milliseconds(400)), 1) << "nothing new";
  node.state_now = "ready";
  EXPECT_EQ(sent_at(milliseconds(410)), 2) << "a new state";
  EXPECT_EQ(sent_at(milliseconds(1'000)), 2) << "a second after the last one";
  EXPECT_EQ(sent_at(milliseconds(1'410)), 3);
}

TEST(HeartbeatTest, AStateThatFluttersMakesNoFloodAndItsLastIsTold) {
  const auto bus = OpenBus("memq://");
  Inbox inbox;
  Outbox out(*bus, 7);
  Heartbeat heartbeat("test", "", out, *bus, *bus, inbox);
  StateNode node;
  Time next = Time(milliseconds(0));
  for (int i = 0; i < 1000; ++i) {
    node.state_now = "state " + std::to_string(i);
    next = heartbeat.Advance(node, Time(milliseconds(i)));
  }
  EXPECT_EQ(bus->counters().sent, 10);
  EXPECT_EQ(next, Time(milliseconds(1'000))) << "999 is still to be told";
  heartbeat.Advance(node, next);
  EXPECT_EQ(bus->counters().sent, 11);
}

TEST(EventLoopTest, LooksAfterEveryTurnAndWakesForIt) {
  const StopSignal stop;
  Inbox inbox;
  EventLoop loop(inbox, stop);
  EchoNode node;
  node.until_end = Clock::now() + std::chrono::seconds(20);
  int looks = 0;
  loop.AfterTurn([&](Time now) {
    // Ends the loop at its second look, which nothing else brings about.
    if (++looks == 2) node.got_pose = true;
    return now + milliseconds(5);
  });
  loop.Run(node);
  EXPECT_EQ(looks, 2);
}

TEST(NodeTest, CountsWhatDoesNotDecode) {
  EchoNode node;
  node.Receive(RawMessage{Channel::kPose, {1, 2, 3}}, Clock::now());
  node.Receive(RawMessage{Channel::kPose,
                          Encode(testing::FilledMessage<terra_msg::pose_t>())},
               Clock::now());
  Counters counters;
  node.AddCounters(counters);
  EXPECT_EQ(counters, (Counters{{"received", 2}, {"malformed", 1}}));
  EXPECT_TRUE(node.got_pose);
}

// Beyond FD_SETSIZE liblcm would end the process.
TEST(BusOpenTest, IsRefusedWhenLcmWouldGetDescriptorsItCannotUse) {
  rlimit before{};
  getrlimit(RLIMIT_NOFILE, &before);
  rlimit enough = before;
  enough.rlim_cur = std::max<rlim_t>(before.rlim_cur, FD_SETSIZE + 100);
  if (setrlimit(RLIMIT_NOFILE, &enough) != 0) {
    GTEST_SKIP() << "this user may not open " << FD_SETSIZE << " files";
  }
  std::vector<int> opened = {open("/dev/null", O_RDONLY)};
  while (opened.back() < FD_SETSIZE) {
    opened.push_back(open("/dev/null", O_RDONLY));
    ASSERT_GE(opened.back(), 0);
  }
  const auto bus = Bus::Open("memq://", ChannelNames());
  for (const int fd : opened) close(fd);
  setrlimit(RLIMIT_NOFILE, &before);
  ASSERT_FALSE(bus.ok());
  EXPECT_NE(bus.error().message.find("file descriptors are open"),
            std::string::npos);
  EXPECT_TRUE(Bus::Open("memq://", ChannelNames()).ok());
}

}  // namespace
}  // namespace terra::bus
