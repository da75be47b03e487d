#include "bus/advice_receiver.h"

#include <algorithm>
#include <utility>

namespace terra::bus {
namespace {

constexpr std::int64_t kSecondUs = 1'000'000;

}  // namespace

bool AdviceRateLimiter::Admit(SenderAddress sender, std::int64_t now_us) {
  now_us_ = std::max(now_us_, now_us);
  while (!last_second_.empty() &&
         last_second_.front().time_us <= now_us_ - kSecondUs) {
    const auto row = of_sender_.find(last_second_.front().sender);
    if (--row->second == 0) {
      of_sender_.erase(row);
    }
    last_second_.pop_front();
  }
  if (last_second_.size() >= limits_.all) {
    return false;
  }
  const auto row = of_sender_.find(sender);
  if ((row == of_sender_.end() ? 0 : row->second) >= limits_.per_sender) {
    return false;
  }
  ++of_sender_[sender];
  last_second_.push_back({now_us_, sender});
  return true;
}

Result<AdviceReceiver> AdviceReceiver::Open(
    const std::string& url, const std::vector<std::string>& channels,
    AdviceRateLimiter::Limits limits) {
  Result<UdpmReceiver> receiver = UdpmReceiver::Open(url);
  if (!receiver) return receiver.error();
  std::vector<Heard> heard;
  heard.reserve(channels.size());
  for (const std::string& channel : channels) {
    heard.push_back({channel, AdviceRateLimiter(limits), 0});
  }
  return AdviceReceiver(*std::move(receiver), std::move(heard));
}

std::size_t AdviceReceiver::Drain(std::int64_t now_us,
                                  std::size_t max_datagrams,
                                  const Handler& handler) {
  const std::size_t read = receiver_.Drain(
      max_datagrams, [&](const LcmDatagram& datagram, SenderAddress sender) {
        Take(datagram, sender, now_us, handler);
      });
  const UdpmReceiver::Counters& all = receiver_.counters();
  counters_.received = all.received;
  counters_.malformed = all.malformed + all.fragments;
  counters_.lost_in_kernel = all.lost_in_kernel;
  return read;
}

void AdviceReceiver::Take(const LcmDatagram& datagram, SenderAddress sender,
                          std::int64_t now_us, const Handler& handler) {
  const auto heard =
      std::find_if(heard_.begin(), heard_.end(), [&datagram](const Heard& one) {
        return one.channel == datagram.channel;
      });
  if (heard == heard_.end()) {
    ++counters_.other_channel;
  } else if (!heard->limiter.Admit(sender, now_us)) {
    ++heard->over_limit;
    ++counters_.over_limit;
  } else {
    ++counters_.delivered;
    handler(datagram, sender);
  }
}

std::uint64_t AdviceReceiver::over_limit(const std::string& channel) const {
  for (const Heard& one : heard_) {
    if (one.channel == channel) return one.over_limit;
  }
  return 0;
}

}  // namespace terra::bus
