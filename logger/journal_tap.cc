#include "logger/journal_tap.h"

#include <algorithm>

#include "logger/log_event.h"

namespace terra::logger {
namespace {

// Every message begins with fingerprint, utime, session, seq, of 8 bytes each.
constexpr std::size_t kSessionAt = 16;
constexpr std::size_t kEnvelopeBytes = 32;

}  // namespace

bool JournalSpeakers::MaySpeak(bus::SenderAddress sender,
                               std::int64_t session) {
  const auto of_session =
      std::ranges::find(speakers_, session, &Speaker::session);
  if (of_session != speakers_.end() && of_session->sender != sender) {
    return false;
  }
  // A socket speaks for one session at a time and has one budget, so that
  // nobody fills the list or the log with one.
  const auto known = std::ranges::find(speakers_, sender, &Speaker::sender);
  if (known != speakers_.end()) {
    known->session = session;
    speakers_.splice(speakers_.begin(), speakers_, known);
  } else {
    speakers_.push_front({.sender = sender, .session = session});
    if (speakers_.size() > kMaxSpeakers) speakers_.pop_back();
  }
  return true;
}

bool JournalSpeakers::MaySay(std::int64_t bytes, std::int64_t now_us) {
  return speakers_.front().budget.Take(bytes, 0, now_us) &&
         of_all_.Take(bytes, 0, now_us);
}

Result<JournalTap> JournalTap::Open(const std::string& url,
                                    const std::string& channel) {
  Result<bus::UdpmReceiver> receiver = bus::UdpmReceiver::Open(url);
  if (!receiver) return receiver.error();
  return JournalTap(*std::move(receiver), channel);
}

bool JournalTap::Admit(const bus::LcmDatagram& datagram,
                       bus::SenderAddress sender, std::int64_t now_us) {
  const std::span<const std::uint8_t> bytes = datagram.payload;
  if (datagram.channel != channel_ || bytes.size() < kEnvelopeBytes ||
      !speakers_.MaySpeak(sender, ReadBigEndian64(bytes.data() + kSessionAt))) {
    ++counters_.foreign;
    return false;
  }
  if (!speakers_.MaySay(std::ssize(bytes), now_us)) {
    ++counters_.over_limit;
    return false;
  }
  return true;
}

void JournalTap::Drain(std::int64_t now_us, std::size_t max_datagrams,
                       const Handler& handler) {
  receiver_.Drain(max_datagrams, [&](const bus::LcmDatagram& datagram,
                                     bus::SenderAddress sender) {
    if (Admit(datagram, sender, now_us)) handler(datagram, sender);
  });
  counters_.lost_in_kernel = receiver_.counters().lost_in_kernel;
}

}  // namespace terra::logger
