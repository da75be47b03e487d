#include "bus/advice_receiver.h"

#include <poll.h>
#include <unistd.h>

#include <map>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "tests/support/random_map.h"

namespace terra::bus {
namespace {

using ::testing::ElementsAre;

using Bytes = std::vector<std::uint8_t>;

Bytes Datagram(const std::string& channel, std::size_t payload_bytes,
               std::uint32_t magic = 0x4c433032) {
  Bytes bytes;
  for (const std::uint32_t word : {magic, std::uint32_t{7}}) {
    for (int shift = 24; shift >= 0; shift -= 8) {
      bytes.push_back(static_cast<std::uint8_t>(word >> shift));
    }
  }
  bytes.insert(bytes.end(), channel.begin(), channel.end());
  bytes.push_back(0);
  bytes.resize(bytes.size() + payload_bytes, 0xab);
  return bytes;
}

TEST(ParseLcmDatagram, ReadsWhatLcmSendsInOneDatagram) {
  const Bytes bytes = Datagram("TERRA_ADVICE", 3);
  const auto datagram = ParseLcmDatagram(bytes);
  ASSERT_TRUE(datagram);
  EXPECT_EQ(datagram->sequence, 7U);
  EXPECT_EQ(datagram->channel, "TERRA_ADVICE");
  EXPECT_THAT(datagram->payload, ElementsAre(0xab, 0xab, 0xab));
  EXPECT_TRUE(ParseLcmDatagram(Datagram("A", 0)));
}

TEST(ParseLcmDatagram, RefusesEverythingElse) {
  EXPECT_FALSE(ParseLcmDatagram({}));
  EXPECT_FALSE(ParseLcmDatagram(Datagram("A", 4, 0x4c433033))) << "fragment";
  EXPECT_FALSE(ParseLcmDatagram(Datagram("", 4))) << "no name";
  EXPECT_FALSE(ParseLcmDatagram(Datagram("A B", 4))) << "blank in the name";
  EXPECT_FALSE(ParseLcmDatagram(Datagram("A\xff", 4))) << "not ASCII";
  Bytes without_end = Datagram("ABCD", 0);
  without_end.pop_back();
  EXPECT_FALSE(ParseLcmDatagram(without_end));
}

TEST(ParseLcmDatagram, HoldsTheLimitsOnBothSides) {
  EXPECT_TRUE(ParseLcmDatagram(Datagram(std::string(63, 'A'), 1)));
  EXPECT_FALSE(ParseLcmDatagram(Datagram(std::string(64, 'A'), 1)));
  EXPECT_TRUE(ParseLcmDatagram(Datagram("A", 60'000)));
  EXPECT_FALSE(ParseLcmDatagram(Datagram("A", 60'001)));
}

TEST(ParseLcmDatagram, StaysInsideAnyBytes) {
  terra::testing::Random random(1);
  const Bytes good = Datagram("TERRA_ADVICE", 8);
  for (int round = 0; round < 20'000; ++round) {
    Bytes bytes(good.begin(), good.begin() + random.Int(0, 29));
    for (int change = random.Int(0, 3); change > 0 && !bytes.empty();
         --change) {
      bytes[static_cast<std::size_t>(
          random.Int(0, static_cast<int>(bytes.size()) - 1))] =
          static_cast<std::uint8_t>(random.Int(0, 255));
    }
    // Exactly as long as it is, so that a sanitizer sees one byte too far.
    const Bytes exact(bytes);
    const auto datagram = ParseLcmDatagram(exact);
    if (datagram) {
      EXPECT_EQ(8 + datagram->channel.size() + 1 + datagram->payload.size(),
                exact.size());
    }
  }
}

TEST(AdviceRateLimiter, AdmitsTwentyOfOneSenderInAnySecond) {
  AdviceRateLimiter limiter;
  const SenderAddress sender{1, 1};
  int admitted = 0;
  for (int i = 0; i < 1000; ++i) admitted += limiter.Admit(sender, 500'000);
  EXPECT_EQ(admitted, 20);
  EXPECT_FALSE(limiter.Admit(sender, 1'499'999));
  EXPECT_TRUE(limiter.Admit(sender, 1'500'000));
}

TEST(AdviceRateLimiter, AFloodDoesNotSilenceAnotherSender) {
  AdviceRateLimiter limiter;
  for (std::int64_t now = 0; now < 10'000'000; now += 1'000) {
    limiter.Admit({1, 1}, now);
    if (now % 100'000 == 0) {
      EXPECT_TRUE(limiter.Admit({1, 2}, now));
    }
  }
}

TEST(AdviceRateLimiter, AdmitsTwoHundredTogetherWhateverTheAddresses) {
  AdviceRateLimiter limiter;
  std::vector<std::int64_t> admitted;
  for (std::uint32_t i = 0; i < 50'000; ++i) {
    const std::int64_t now = std::int64_t{i} * 100;
    if (limiter.Admit({i, static_cast<std::uint16_t>(i)}, now)) {
      admitted.push_back(now);
    }
    ASSERT_LE(limiter.num_senders(), 200U);
  }
  EXPECT_EQ(admitted.size(), 5U * 200U);
  for (std::size_t i = 200; i < admitted.size(); ++i) {
    EXPECT_GE(admitted[i] - admitted[i - 200], 1'000'000);
  }
}

TEST(AdviceRateLimiter, AClockThatRunsBackAdmitsNoMore) {
  AdviceRateLimiter limiter({1, 10});
  EXPECT_TRUE(limiter.Admit({1, 1}, 5'000'000));
  EXPECT_FALSE(limiter.Admit({1, 1}, -5'000'000));
  EXPECT_FALSE(limiter.Admit({1, 1}, 5'999'999));
  EXPECT_TRUE(limiter.Admit({1, 1}, 6'000'000));
}

/// Sends from a socket of its own, as an advisor would.
class Sender {
 public:
  explicit Sender(std::uint16_t port)
      : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(port);
    inet_pton(AF_INET, "239.255.76.67", &to_.sin_addr);
    const unsigned char ttl = 0;
    setsockopt(fd_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof(ttl));
  }
  ~Sender() { close(fd_); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  bool Send(const Bytes& bytes) const {
    return sendto(fd_, bytes.data(), bytes.size(), 0,
                  reinterpret_cast<const sockaddr*>(&to_),
                  sizeof(to_)) == static_cast<ssize_t>(bytes.size());
  }

 private:
  int fd_;
  sockaddr_in to_{};
};

void DrainUntil(AdviceReceiver& receiver, std::uint64_t received,
                const AdviceReceiver::Handler& handler) {
  while (receiver.counters().received < received) {
    pollfd ready{receiver.fd(), POLLIN, 0};
    ASSERT_EQ(poll(&ready, 1, 5'000), 1) << "nothing came for 5 s";
    receiver.Drain(0, 1'000, handler);
  }
}

TEST(AdviceReceiver, TakesItsChannelAndCountsTheRest) {
  const std::string url = "udpm://239.255.76.67:17701?ttl=0";
  auto receiver = AdviceReceiver::Open(url, "TERRA_ADVICE");
  ASSERT_TRUE(receiver) << receiver.error().message;
  auto second = AdviceReceiver::Open(url, "TERRA_ADVICE");
  ASSERT_TRUE(second) << "two listeners on one host";

  const Sender sender(17701);
  ASSERT_TRUE(sender.Send(Datagram("TERRA_ADVICE", 60'000)));
  ASSERT_TRUE(sender.Send(Datagram("ROBOT_TERRA_ADVICE", 10)));
  ASSERT_TRUE(sender.Send(Datagram("TERRA_ADVICE", 60'001)));
  ASSERT_TRUE(sender.Send(Bytes(65'000, 0xff)));
  ASSERT_TRUE(sender.Send(Bytes{}));
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(sender.Send(Datagram("TERRA_ADVICE", 5)));
  }
  for (AdviceReceiver* one : {&receiver.value(), &second.value()}) {
    std::vector<std::size_t> sizes;
    DrainUntil(*one, 35, [&](const LcmDatagram& datagram, SenderAddress) {
      sizes.push_back(datagram.payload.size());
    });
    EXPECT_EQ(one->counters().malformed, 3U);
    EXPECT_EQ(one->counters().other_channel, 1U);
    EXPECT_EQ(one->counters().delivered, 20U);
    EXPECT_EQ(one->counters().over_limit, 11U);
    ASSERT_EQ(sizes.size(), 20U);
    EXPECT_EQ(sizes.front(), 60'000U);
    EXPECT_EQ(sizes.back(), 5U);
  }
}

// What one channel is flooded with is no other channel's loss.
TEST(AdviceReceiver, EachChannelHasItsOwnLimit) {
  auto receiver =
      AdviceReceiver::Open("udpm://239.255.76.67:17704?ttl=0",
                           std::vector<std::string>{"ADVICE", "STATUS"});
  ASSERT_TRUE(receiver) << receiver.error().message;
  const Sender sender(17704);
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(sender.Send(Datagram("STATUS", 1)));
  for (int i = 0; i < 25; ++i) ASSERT_TRUE(sender.Send(Datagram("ADVICE", 1)));
  std::map<std::string, int> heard;
  DrainUntil(*receiver, 75, [&heard](const LcmDatagram& one, SenderAddress) {
    ++heard[std::string(one.channel)];
  });
  EXPECT_EQ(heard["STATUS"], 20);
  EXPECT_EQ(heard["ADVICE"], 20);
  EXPECT_EQ(receiver->over_limit("STATUS"), 30U);
  EXPECT_EQ(receiver->over_limit("ADVICE"), 5U);
  EXPECT_EQ(receiver->over_limit("POSE"), 0U);
}

TEST(UdpmReceiver, RefusesAndCountsFragmentsOfEverySize) {
  auto receiver = UdpmReceiver::Open("udpm://239.255.76.67:17705?ttl=0");
  ASSERT_TRUE(receiver) << receiver.error().message;
  const Sender sender(17705);
  const std::uint32_t fragment = 0x4c433033;
  ASSERT_TRUE(sender.Send(Datagram("", 0, fragment)));
  ASSERT_TRUE(sender.Send(Datagram("A", 500, fragment)));
  ASSERT_TRUE(sender.Send(Datagram("A", 65'000, fragment)));
  ASSERT_TRUE(sender.Send(Datagram("A", 65'000)));
  ASSERT_TRUE(sender.Send(Datagram("A", 1)));
  int heard = 0;
  while (receiver->counters().received < 5) {
    pollfd ready{receiver->fd(), POLLIN, 0};
    ASSERT_EQ(poll(&ready, 1, 5'000), 1) << "nothing came for 5 s";
    receiver->Drain(100, [&heard](const LcmDatagram&, SenderAddress) {
      ++heard;
    });
  }
  EXPECT_EQ(receiver->counters().fragments, 3U);
  EXPECT_EQ(receiver->counters().malformed, 1U);
  EXPECT_EQ(heard, 1);
}

TEST(AdviceReceiver, ReadsNoMoreThanAskedAtATime) {
  auto receiver = AdviceReceiver::Open("udpm://239.255.76.67:17702?ttl=0", "A");
  ASSERT_TRUE(receiver) << receiver.error().message;
  const Sender sender(17702);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(sender.Send(Datagram("A", 1)));
  pollfd ready{receiver->fd(), POLLIN, 0};
  ASSERT_EQ(poll(&ready, 1, 5'000), 1);
  const auto ignore = [](const LcmDatagram&, SenderAddress) {};
  EXPECT_EQ(receiver->Drain(0, 3, ignore), 3U);
  EXPECT_EQ(receiver->Drain(0, 100, ignore), 17U);
  EXPECT_EQ(receiver->Drain(0, 100, ignore), 0U);
}

TEST(AdviceReceiver, CountsWhatTheKernelDropped) {
  auto receiver = AdviceReceiver::Open(
      "udpm://239.255.76.67:17703?ttl=0&recv_buf_size=20000", "A");
  ASSERT_TRUE(receiver) << receiver.error().message;
  const Sender sender(17703);
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(sender.Send(Datagram("A", 1000)));
  const auto ignore = [](const LcmDatagram&, SenderAddress) {};
  receiver->Drain(0, 1'000, ignore);
  ASSERT_TRUE(sender.Send(Datagram("A", 1)));
  DrainUntil(receiver.value(), receiver->counters().received + 1, ignore);
  EXPECT_EQ(receiver->counters().received + receiver->counters().lost_in_kernel,
            501U);
  EXPECT_GT(receiver->counters().lost_in_kernel, 0U);
}

TEST(AdviceReceiver, ABusyPortIsNamed) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(17606);
  ASSERT_EQ(bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  const auto receiver =
      AdviceReceiver::Open("udpm://239.255.76.67:17606?ttl=0", "A");
  close(fd);
  ASSERT_FALSE(receiver);
  EXPECT_THAT(receiver.error().message,
              ::testing::HasSubstr("17606 is taken by another program"));
}

TEST(AdviceReceiver, RefusesOtherUrlsWithAReason) {
  for (const char* url : {"memq://", "file://x.log", "udpm://10.0.0.1:7667",
                          "udpm://239.255.76.67:66000", ""}) {
    const auto receiver = AdviceReceiver::Open(url, "A");
    ASSERT_FALSE(receiver) << url;
    EXPECT_EQ(receiver.error().code, ErrorCode::kInvalid);
  }
}

}  // namespace
}  // namespace terra::bus
