#include "logger/bus_tap.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <sys/eventfd.h>

#include "bus/advisor_channels.h"
#include "bus/bus.h"
#include "bus/envelope.h"
#include "bus/lcm_url.h"
#include "logger/log_event.h"

namespace terra::logger {
namespace {

constexpr std::int64_t kReceiveBuffer = std::int64_t{16} << 20;
constexpr int kLcmQueueCapacity = 20'000;
constexpr int kSilenceMs = 20;  // At the end.
constexpr int kAdviceWaitsMs = 2;
// On a bus that never falls silent: the other sockets' buffers hold this long.
constexpr std::chrono::milliseconds kAdviceWaitsAtMost{20};
constexpr std::chrono::seconds kEndWaitsAtMost{5};
constexpr std::size_t kDatagramsPerTurn = 4'096;

// liblcm complains loudly about a size that the kernel does not give.
std::int64_t LargestReceiveBuffer() {
  std::int64_t limit = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> limit;
  return std::min(limit, kReceiveBuffer);
}

void Copy(std::uint64_t from, std::atomic<std::int64_t>& to) {
  to = static_cast<std::int64_t>(from);
}

}  // namespace

std::string WithReceiveBuffer(const std::string& url, std::int64_t bytes) {
  Result<bus::LcmUrl> parsed = bus::ParseLcmUrl(url);
  if (!parsed || !parsed->is_udpm() || parsed->recv_buf_size >= bytes) {
    return url;
  }
  // Of an option that is given twice the last one counts.
  parsed->options += (parsed->options.empty() ? "" : "&") +
                     std::string("recv_buf_size=") + std::to_string(bytes);
  return parsed->text();
}

Result<std::unique_ptr<BusTap>> BusTap::Open(const Urls& urls,
                                             const bus::ChannelNames& names,
                                             EventQueue& queue) {
  Result<std::unique_ptr<bus::LcmLink>> link = bus::LcmLink::Open(
      WithReceiveBuffer(urls.deployed, LargestReceiveBuffer()));
  if (!link) return link.error();
  std::unique_ptr<BusTap> tap(
      new BusTap(queue, *std::move(link), eventfd(0, EFD_CLOEXEC)));
  if (tap->stop_fd_ < 0) {
    return bus::DiagnoseBus(urls.deployed, std::strerror(errno));
  }
  const Status subscribed = tap->link_->Subscribe(".*", &BusTap::OnMessage,
                                                  tap.get(), kLcmQueueCapacity);
  if (!subscribed) return subscribed.error();
  tap->journal_channel_ = names.name(bus::Channel::kGateStep);
  const Status advice = tap->OpenAdvice(urls.advice, names);
  if (!advice) return advice.error();
  const Status journal = tap->OpenJournal(urls.journal);
  if (!journal) return journal.error();
  tap->thread_ = std::thread([listening = tap.get()] {
    listening->Listen();
  });
  return tap;
}

// What does not travel on a port of its own is heard on the deployed bus.
bool BusTap::IsApart(const std::string& text) const {
  const Result<bus::LcmUrl> url = bus::ParseLcmUrl(text);
  return url && url->is_udpm() && !bus::SameBus(*url, link_->url());
}

Status BusTap::OpenAdvice(const std::string& url,
                          const bus::ChannelNames& names) {
  if (!IsApart(url)) return Done{};
  advice_channel_ = names.name(bus::Channel::kAdvice);
  std::vector<std::string> channels = {advice_channel_};
  for (const bus::Channel channel : bus::kAdvisorChannels) {
    channels.push_back(names.name(channel));
  }
  auto opened = bus::AdviceReceiver::Open(url, channels);
  if (!opened) return opened.error();
  advice_.emplace(*std::move(opened));
  return Done{};
}

Status BusTap::OpenJournal(const std::string& url) {
  if (!IsApart(url)) return Done{};
  auto opened = JournalTap::Open(WithReceiveBuffer(url, LargestReceiveBuffer()),
                                 journal_channel_);
  if (!opened) return opened.error();
  journal_.emplace(*std::move(opened));
  return Done{};
}

BusTap::BusTap(EventQueue& queue, std::unique_ptr<bus::LcmLink> link,
               int stop_fd)
    : queue_(queue), link_(std::move(link)), stop_fd_(stop_fd) {}

BusTap::~BusTap() {
  if (thread_.joinable()) {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t n = write(stop_fd_, &one, sizeof one);
    thread_.join();
  }
  if (stop_fd_ >= 0) close(stop_fd_);
}

void BusTap::OnMessage(std::string_view channel,
                       std::span<const std::uint8_t> bytes,
                       void* tap) noexcept {
  auto& self = *static_cast<BusTap*>(tap);
  if (channel == bus::kSelfTestChannel) return;
  // A name that is not one word would be taken for damage in the log.
  // The journal is heard on its own port only.
  if (bytes.size() > kMaxLogData || !IsLogChannel(channel) ||
      (self.journal_ && channel == self.journal_channel_)) {
    ++self.counters_.refused;
    return;
  }
  ++self.counters_.heard;
  self.queue_.Push(bus::UnixMicroseconds(), channel, bytes);
}

// THREADING: the one thread that handles this link and the advice socket.
// It copies messages into the queue, stamped with the time, and never writes.
// Advice and journal wait a moment in their sockets, so that the baseline that
// an advice answers, and the decisions of a step, which may come later over the
// other socket, stand before them in the log.
void BusTap::Listen() {
  std::array<pollfd, 4> waited = {
      pollfd{stop_fd_, POLLIN, 0}, pollfd{link_->fd(), POLLIN, 0},
      pollfd{advice_ ? advice_->fd() : -1, POLLIN, 0},
      pollfd{journal_ ? journal_->fd() : -1, POLLIN, 0}};
  while (true) {
    if (poll(waited.data(), waited.size(), -1) < 0) continue;  // EINTR
    if (waited[0].revents != 0) break;
    const bool journal = waited[3].revents != 0;
    const bool advice = waited[2].revents != 0 || (journal && advice_);
    HearDeployedBus(waited[1], advice || journal ? kAdviceWaitsMs : 0,
                    kAdviceWaitsAtMost);
    if (advice) DrainAdvice();
    if (journal) DrainJournal();
  }
  HearDeployedBus(waited[1], kSilenceMs, kEndWaitsAtMost);
  if (advice_) DrainAdvice();
  if (journal_) DrainJournal();
}

// Hears what is under way, until the bus was silent for so long. One that never
// falls silent is not waited for.
void BusTap::HearDeployedBus(pollfd& lcm, int silence_ms,
                             bus::Duration at_most) {
  const bus::Time until = bus::Clock::now() + at_most;
  const int messages = link_->url().is_udpm()
                           ? static_cast<int>(bus::LcmLink::kMessagesPerHandle)
                           : 1;
  for (int i = 0; i < kLcmQueueCapacity && poll(&lcm, 1, silence_ms) > 0;
       i += messages) {
    if (!link_->Handle()) lcm.fd = -1;
    if (bus::Clock::now() >= until) break;
  }
  const bus::UdpmReceiver::Counters read = link_->counters();
  Copy(read.fragments, counters_.fragments);
  Copy(read.malformed, counters_.no_message);
  Copy(read.lost_in_kernel, counters_.lost_in_kernel);
}

void BusTap::Take(const bus::LcmDatagram& datagram) {
  ++counters_.heard;
  queue_.Push(bus::UnixMicroseconds(), datagram.channel, datagram.payload);
}

void BusTap::DrainAdvice() {
  advice_->Drain(bus::MonotonicMicroseconds(bus::Clock::now()),
                 kDatagramsPerTurn,
                 [this](const bus::LcmDatagram& datagram, bus::SenderAddress) {
                   Take(datagram);
                 });
  const bus::AdviceReceiver::Counters& read = advice_->counters();
  const std::uint64_t of_advice = advice_->over_limit(advice_channel_);
  Copy(of_advice, counters_.advice_over_limit);
  Copy(read.over_limit - of_advice, counters_.advisors_over_limit);
  Copy(read.malformed, counters_.advice_malformed);
  Copy(read.lost_in_kernel, counters_.advice_lost_in_kernel);
}

void BusTap::DrainJournal() {
  journal_->Drain(bus::MonotonicMicroseconds(bus::Clock::now()),
                  kDatagramsPerTurn,
                  [this](const bus::LcmDatagram& datagram, bus::SenderAddress) {
                    Take(datagram);
                  });
  const JournalTap::Counters& read = journal_->counters();
  Copy(read.foreign, counters_.journal_foreign);
  Copy(read.over_limit, counters_.journal_over_limit);
  Copy(read.lost_in_kernel, counters_.journal_lost_in_kernel);
}

}  // namespace terra::logger
