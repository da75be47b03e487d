#include "logger/sequence_gaps.h"

#include <algorithm>
#include <optional>

#include "logger/log_event.h"

namespace terra::logger {
namespace {

// Every message begins with its type's fingerprint, utime, session and seq,
// eight bytes each.
constexpr std::size_t kSessionAt = 16;
constexpr std::size_t kSeqAt = 24;
constexpr std::size_t kEnvelopeBytes = 32;

struct Envelope {
  bus::Channel channel;
  std::int64_t session = 0;
  std::int64_t seq = 0;
};

std::optional<Envelope> EnvelopeOf(const bus::ChannelNames& channels,
                                   std::string_view name,
                                   std::span<const std::uint8_t> data) {
  const auto channel = channels.Find(name);
  if (!channel || *channel == bus::Channel::kAdvice ||
      *channel == bus::Channel::kLog || data.size() < kEnvelopeBytes) {
    return std::nullopt;
  }
  return Envelope{*channel, ReadBigEndian64(data.data() + kSessionAt),
                  ReadBigEndian64(data.data() + kSeqAt)};
}

}  // namespace

void SequenceGaps::Remember(std::string_view channel,
                            std::span<const std::uint8_t> data) {
  const auto message = EnvelopeOf(channels_, channel, data);
  if (!message) return;
  const Sender sender{message->channel, message->session};
  if (last_seq_.size() >= kMaxSenders && !last_seq_.contains(sender)) return;
  std::int64_t& last = last_seq_[sender];
  last = std::max(last, message->seq);
}

std::int64_t SequenceGaps::Missing(std::string_view channel,
                                   std::span<const std::uint8_t> data) {
  if (last_seq_.empty()) return 0;
  const auto message = EnvelopeOf(channels_, channel, data);
  if (!message) return 0;
  const auto known = last_seq_.find({message->channel, message->session});
  if (known == last_seq_.end()) return 0;
  const std::int64_t last = known->second;
  last_seq_.erase(known);
  // A claimed seq may be anything; no sender says 1e9 messages meanwhile.
  constexpr std::int64_t kMaxGap = 1'000'000'000;
  return last >= 0 && message->seq > last && message->seq - last <= kMaxGap
             ? message->seq - last - 1
             : 0;
}

}  // namespace terra::logger
