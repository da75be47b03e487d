#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "bus/message_texts.h"
#include "bus/messages.h"
#include "bus/transport.h"

namespace terra::bus {

/// Returns a random number that is never 0: a session or a request id.
std::int64_t RandomId();

/// Returns microseconds since 1970, for stamps that people read.
std::int64_t UnixMicroseconds();

/// Stamps and sends what one process says: utime, session, and seq per channel.
/// No text of a message can make it unfit to be sent: texts are cleaned here.
/// Threads: one.
class Outbox {
 public:
  Outbox(Transport& transport, std::int64_t session)
      : transport_(transport), session_(session) {}

  std::int64_t session() const { return session_; }

  /// Stamps the message, cleans its texts and sends it. Returns false when the
  /// bus refused; seq counts it all the same, so that receivers see the loss.
  template <typename T>
  bool Send(T& message) {
    constexpr Channel kChannel = MessageTraits<T>::kChannel;
    message.utime = UnixMicroseconds();
    message.session = session_;
    message.seq = ++seq_[static_cast<std::size_t>(kChannel)];
    CleanTexts(message);
    return transport_.Publish(kChannel, Encode(message));
  }

 private:
  Transport& transport_;
  std::int64_t session_;
  std::array<std::int64_t, kNumChannels> seq_{};
};

/// Tells the current sender of a channel from the ones it replaced.
///
/// A session that was never heard takes over at once: a restarted process is
/// back without waiting. The one it replaced is ignored from then on, and while
/// it still speaks there are two senders, which somebody should hear of.
class SenderTracker {
 public:
  enum class Sender {
    kCurrent,
    kTookOver,  ///< A new session; from now on the current one.
    kReplaced,  ///< An earlier session still speaks: ignore it.
    kRepeated,  ///< A seq of the current session that is not newer: ignore it.
  };

  Sender Look(std::int64_t session, std::int64_t seq);

  /// True when the message is to be used.
  bool Accept(std::int64_t session, std::int64_t seq) {
    const Sender sender = Look(session, seq);
    return sender == Sender::kCurrent || sender == Sender::kTookOver;
  }

  std::int64_t session() const { return session_; }
  /// Messages of current sessions that never came, by gaps in seq.
  std::uint64_t lost() const { return lost_; }
  /// Messages of replaced sessions.
  std::int64_t from_replaced() const { return from_replaced_; }

 private:
  std::int64_t session_ = 0;
  std::int64_t seq_ = 0;
  std::uint64_t lost_ = 0;
  std::int64_t from_replaced_ = 0;
  std::deque<std::int64_t> replaced_;
};

}  // namespace terra::bus
