// Buses that end: a tcpq:// bus whose hub goes away and comes back, a log that
// is played to its end.
#include <poll.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include "bus/bus.h"
#include "bus/envelope.h"
#include "bus/lcm_link.h"
#include "bus/log.h"
#include "bus/time.h"
#include "tests/filled_messages.h"
#include "tests/support/captured_errors.h"
#include "tests/support/tcpq_hub.h"
#include "tests/support/temp_folder.h"

namespace terra::bus {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using terra::testing::CapturedErrors;
using terra::testing::TcpqHub;

constexpr seconds kPatience{20};

std::unique_ptr<Bus> OpenBus(const std::string& url) {
  Result<std::unique_ptr<Bus>> bus = Bus::Open(url, ChannelNames());
  if (!bus) ADD_FAILURE() << bus.error().message;
  return *std::move(bus);
}

// A process that only hears, and one that only publishes.
class TcpqTest : public ::testing::Test {
 protected:
  // Words of ours go to standard error, as liblcm's do.
  static void SetUpTestSuite() { SetLogName("tcpq_test"); }

  void Open(const std::string& url) {
    hears_ = OpenBus(url);
    ASSERT_TRUE(hears_->Listen(kChannels, inbox_).ok());
    says_ = OpenBus(url);
  }

  bool Say() {
    auto pose = testing::FilledMessage<terra_msg::pose_t>();
    return Outbox(*says_, 7).Send(pose);
  }
  // Whether a message comes through, said again and again.
  bool Connected() {
    for (const Time until = Clock::now() + kPatience; Clock::now() < until;) {
      Say();
      pollfd fd{inbox_.fd(), POLLIN, 0};
      poll(&fd, 1, 20);
      inbox_.Clear();
      if (inbox_.Pop()) return true;
    }
    return false;
  }
  // Whether the loss is noticed: nothing can be sent.
  bool Disconnected() {
    for (const Time until = Clock::now() + kPatience; Clock::now() < until;) {
      if (!Say()) return true;
      poll(nullptr, 0, 5);
    }
    return false;
  }

  static constexpr std::array<Channel, 1> kChannels = {Channel::kPose};
  Inbox inbox_;
  std::unique_ptr<Bus> hears_;
  std::unique_ptr<Bus> says_;
};

double ProcessorSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds_of = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) +
           1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

TEST_F(TcpqTest, ComesBackWhenTheHubDoes) {
  std::optional<TcpqHub> hub(std::in_place);
  const int port = hub->port();
  Open(hub->url());
  ASSERT_TRUE(Connected());
  for (int i = 0; i < 3; ++i) {
    hub.reset();
    ASSERT_TRUE(Disconnected());
    EXPECT_GT(says_->counters().send_failed, 0);
    hub.emplace(port);
    ASSERT_TRUE(Connected()) << "after loss " << i;
  }
}

TEST_F(TcpqTest, StartsWithoutAHubAndWaitsForIt) {
  const int port = TcpqHub().port();
  Open("tcpq://127.0.0.1:" + std::to_string(port));
  EXPECT_FALSE(Say());
  const TcpqHub hub(port);
  EXPECT_TRUE(Connected());
}

TEST_F(TcpqTest, AHubMayBeGivenByName) {
  const TcpqHub hub;
  Open("tcpq://localhost:" + std::to_string(hub.port()));
  EXPECT_TRUE(Connected());
}

// It wrote 54 MB in ten seconds, at 77 % of a processor.
TEST_F(TcpqTest, AHubThatIsAwayIsSaidOnceAndCostsNothing) {
  CapturedErrors errors;
  std::optional<TcpqHub> hub(std::in_place);
  const int port = hub->port();
  Open(hub->url());
  ASSERT_TRUE(Connected());
  hub.reset();
  ASSERT_TRUE(Disconnected());
  const double before = ProcessorSeconds();
  for (int i = 0; i < 300; ++i) {
    Say();
    poll(nullptr, 0, 5);
  }
  EXPECT_LT(ProcessorSeconds() - before, 0.3);
  hub.emplace(port);
  ASSERT_TRUE(Connected());
  EXPECT_TRUE(errors.Await("is back", 2)) << "once a bus: " << errors.Text();
  EXPECT_EQ(errors.Times("went away"), 2) << errors.Text();
  EXPECT_EQ(errors.Times("is back"), 2) << errors.Text();
  EXPECT_LT(errors.Text().size(), 3'000U) << errors.Text();
}

// ---- Hubs that do not do their part. ----

// Accepts whoever comes, greets if told to, and reads nothing.
class DeafHub {
 public:
  explicit DeafHub(bool greets) : fd_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    socklen_t size = sizeof address;
    if (bind(fd_, generic, size) != 0 || listen(fd_, 64) != 0 ||
        getsockname(fd_, generic, &size) != 0) {
      ADD_FAILURE() << "the hub cannot listen";
    }
    port_ = ntohs(address.sin_port);
    if (!greets) return;
    thread_ = std::thread([this] {
      constexpr std::array<unsigned char, 8> kGreeting = {
          0x28, 0x76, 0x17, 0xfa, 0, 0, 1, 0};
      for (int client = 0; (client = accept(fd_, nullptr, nullptr)) >= 0;) {
        send(client, kGreeting.data(), kGreeting.size(), MSG_NOSIGNAL);
        clients_.push_back(client);
      }
    });
  }
  ~DeafHub() {
    shutdown(fd_, SHUT_RDWR);
    if (thread_.joinable()) thread_.join();
    for (const int client : clients_) close(client);
    close(fd_);
  }
  DeafHub(const DeafHub&) = delete;
  DeafHub& operator=(const DeafHub&) = delete;

  std::string url() const {
    return "tcpq://127.0.0.1:" + std::to_string(port_);
  }

 private:
  int fd_;
  int port_ = 0;
  std::vector<int> clients_;
  std::thread thread_;
};

TEST_F(TcpqTest, AHubThatDoesNotGreetHoldsNobodyUp) {
  const DeafHub hub(false);
  const Time begin = Clock::now();
  Open(hub.url());
  EXPECT_FALSE(Say());
  says_.reset();
  hears_.reset();
  EXPECT_LT(Clock::now() - begin, seconds(5));
}

TEST_F(TcpqTest, AHubThatReadsNothingHoldsNobodyUp) {
  const DeafHub hub(true);
  says_ = OpenBus(hub.url());
  const std::vector<std::uint8_t> large(kMaxMessageBytes);
  Duration longest{};
  bool refused = false;
  for (int i = 0; i < 2'000 && !refused; ++i) {
    const Time begin = Clock::now();
    refused = !says_->Publish(Channel::kPose, large);
    longest = std::max(longest, Clock::now() - begin);
  }
  EXPECT_TRUE(refused);
  EXPECT_LT(longest, seconds(1));
}

// liblcm leaves the descriptor of a log that is at its end readable for ever.
TEST_F(TcpqTest, ALogThatWasPlayedToItsEndCostsNothing) {
  const terra::testing::TempFolder folder;
  const std::string url = "file://" + folder.Path("a.log");
  {
    const auto writes = OpenBus(url + "?mode=w");
    auto pose = testing::FilledMessage<terra_msg::pose_t>();
    ASSERT_TRUE(Outbox(*writes, 7).Send(pose));
  }
  CapturedErrors errors;
  hears_ = OpenBus(url + "?speed=0");
  ASSERT_TRUE(hears_->Listen(kChannels, inbox_).ok());
  pollfd fd{inbox_.fd(), POLLIN, 0};
  EXPECT_EQ(poll(&fd, 1, 5'000), 1);
  EXPECT_TRUE(inbox_.Pop().has_value());
  const double before = ProcessorSeconds();
  poll(nullptr, 0, 500);
  EXPECT_LT(ProcessorSeconds() - before, 0.1);
  EXPECT_TRUE(errors.Await("was played to its end"));
  EXPECT_EQ(errors.Times("was played to its end"), 1);
}

TEST(LcmLinkTest, ATcpqUrlThatIsNoneIsRefused) {
  EXPECT_FALSE(LcmLink::Open("tcpq://127.0.0.1:70000").ok());
  EXPECT_FALSE(LcmLink::Open("tcpq://127.0.0.1:x").ok());
}

}  // namespace
}  // namespace terra::bus
