// Bytes that are no well-formed message.
#include <limits>

#include "bus/codec.h"
#include "chaos/faults.h"

namespace terra::chaos {
namespace {

using terra_msg::advice_t;
using Bytes = std::vector<std::uint8_t>;

// Where fields of an encoded advice_t begin (lcmtypes/advice_t.lcm): behind the
// fingerprint and nine int64 of header, key and anchor with three int32 come
// the strings; behind these and 23 bytes of numbers the count of waypoints.
constexpr std::size_t kFirstString = 8 + 3 * 8 + 3 * 8 + 2 * 8 + 3 * 4;
std::size_t CountOffset(const advice_t& advice) {
  const auto encoded = [](const std::string& text) {
    return 4 + text.size() + 1;
  };
  return kFirstString + encoded(advice.advisor) + encoded(advice.method) +
         encoded(advice.backend) + encoded(advice.model) + 8 + 4 + 8 + 3;
}

void Overwrite(Bytes& bytes, std::size_t at, std::int32_t value) {
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[at + i] = static_cast<std::uint8_t>(
        static_cast<std::uint32_t>(value) >> (24 - 8 * i));
  }
}

std::int32_t OneOf(Attacker& attacker,
                   std::initializer_list<std::int32_t> values) {
  return values.begin()[attacker.Pick(0, static_cast<int>(values.size()) - 1)];
}

// Where counts stand in the messages of the deployed bus differs, so any four
// bytes behind the fingerprint are one.
std::vector<Datagram> HostileNumber(Attacker& attacker) {
  Attacker::Message message = attacker.Good();
  const int last = static_cast<int>(message.payload.size()) - 4;
  Overwrite(message.payload, static_cast<std::size_t>(attacker.Pick(8, last)),
            OneOf(attacker,
                  {-1, 500'000'000, std::numeric_limits<std::int32_t>::max(),
                   std::numeric_limits<std::int32_t>::min()}));
  return {attacker.Say(message)};
}

// Payload of an advice message of so many bytes, good but for its length.
Bytes LongAdvice(Attacker& attacker, std::size_t bytes) {
  advice_t advice = attacker.Honest();
  advice.answer_text.assign(bytes, 'A');
  return Attacker::Bytes(advice);
}

}  // namespace

std::vector<Datagram> Garbage(Attacker& attacker) {
  Bytes bytes = attacker.RandomBytes(attacker.Pick(0, 400));
  switch (attacker.Pick(0, 2)) {
    case 0:
      return {bytes};  // not even LCM
    case 1:
      return {attacker.Say(bytes)};
    default: {  // LCM's magic, then anything
      const Bytes magic = {'L', 'C', '0',
                           static_cast<std::uint8_t>(attacker.Pick('0', '4'))};
      bytes.insert(bytes.begin(), magic.begin(), magic.end());
      return {bytes};
    }
  }
}

std::vector<Datagram> Truncated(Attacker& attacker) {
  Attacker::Message message = attacker.Good();
  message.payload.resize(static_cast<std::size_t>(
      attacker.Pick(0, static_cast<int>(message.payload.size()) - 1)));
  return {attacker.Say(message)};
}

std::vector<Datagram> BitFlips(Attacker& attacker) {
  Attacker::Message message = attacker.Good();
  Bytes& bytes = message.payload;
  for (int flips = attacker.Pick(1, 3); flips > 0; --flips) {
    const int bit = attacker.Pick(0, static_cast<int>(8 * bytes.size()) - 1);
    bytes[static_cast<std::size_t>(bit / 8)] ^=
        static_cast<std::uint8_t>(1 << (bit % 8));
  }
  return {attacker.Say(message)};
}

std::vector<Datagram> HostileCounts(Attacker& attacker) {
  if (attacker.attacks_deployed_bus()) return HostileNumber(attacker);
  const advice_t advice = attacker.Honest();
  Bytes bytes = Attacker::Bytes(advice);
  Overwrite(bytes, CountOffset(advice),
            OneOf(attacker, {-1, 500'000'000, advice.num_waypoints + 1,
                             std::numeric_limits<std::int32_t>::max(),
                             std::numeric_limits<std::int32_t>::min()}));
  return {attacker.Say(bytes)};
}

std::vector<Datagram> HostileStrings(Attacker& attacker) {
  if (attacker.attacks_deployed_bus()) return HostileNumber(attacker);
  const advice_t advice = attacker.Honest();
  Bytes bytes = Attacker::Bytes(advice);
  if (attacker.OneIn(4)) {
    bytes[kFirstString + 4 + advice.advisor.size()] = 'x';  // the closing zero
  } else {
    Overwrite(bytes, kFirstString,
              OneOf(attacker, {0, -5, 500'000'000,
                               std::numeric_limits<std::int32_t>::max()}));
  }
  return {attacker.Say(bytes)};
}

std::vector<Datagram> VersionSkew(Attacker& attacker) {
  Attacker::Message message = attacker.Good();
  Bytes& bytes = message.payload;
  for (std::size_t i = 0; i < 8; ++i) {
    bytes[i] = static_cast<std::uint8_t>(attacker.Pick(0, 255));
  }
  if (attacker.OneIn(2)) bytes.resize(bytes.size() + 4);  // one more field
  return {attacker.Say(message)};
}

std::vector<Datagram> NoChannelEnd(Attacker& attacker) {
  const std::string& name = attacker.AttackedChannel();
  Datagram datagram = WholeMessage(attacker.NextSequence(), name, {});
  datagram.pop_back();
  if (attacker.OneIn(2)) datagram.insert(datagram.end(), 100, 'A');
  return {datagram};
}

std::vector<Datagram> Oversize(Attacker& attacker) {
  const std::string& name = attacker.AttackedChannel();
  const std::int32_t size =
      OneOf(attacker, {61'000, 131'072, 400'000, 1'000'000});
  const Bytes payload = LongAdvice(attacker, static_cast<std::size_t>(size));
  if (size == 61'000) return {attacker.Say(payload)};
  return Fragments(attacker.NextSequence(), name, payload);
}

std::vector<Datagram> HalfFragments(Attacker& attacker) {
  constexpr std::size_t kSize = 100;
  const std::string& name = attacker.AttackedChannel();
  const Bytes payload = Attacker::Bytes(attacker.Honest());
  std::vector<Datagram> all =
      Fragments(attacker.NextSequence(), name, payload, kSize);
  switch (attacker.Pick(0, 2)) {
    case 0:  // the first one only
      all.resize(1);
      break;
    case 1:  // one of them twice, one of them never
      all.back() = all[all.size() - 2];
      break;
    default:  // the last one first
      std::swap(all.front(), all.back());
      break;
  }
  return all;
}

std::vector<Datagram> OffsetWrap(Attacker& attacker) {
  // A channel that the attacker does not listen to: by liblcm 1.3.1 it would be
  // the first to end. (1.5.2 keeps fragments of any channel, so there it is.)
  const std::string& name = attacker.channel(bus::Channel::kAdvice);
  FragmentHeader header;
  header.sequence = attacker.NextSequence();
  header.message_bytes = 1'000;
  header.count = 3;
  const Datagram first = Fragment(header, name, attacker.RandomBytes(100));
  header.number = 1;
  header.offset = 0xffffff00;
  return {first, Fragment(header, name, attacker.RandomBytes(256))};
}

std::vector<Datagram> SlowDrip(Attacker& attacker) {
  const std::string& name = attacker.AttackedChannel();
  FragmentHeader header;
  // One message for ever: the first fragment again and again, then any other.
  header.sequence = 0x7fffffff;
  header.message_bytes = 65'535 * 16;
  header.count = 65'535;
  header.number = static_cast<std::uint16_t>(
      attacker.OneIn(8) ? 0 : attacker.Pick(1, 65'534));
  header.offset = header.number * 16U;
  return {Fragment(header, name, attacker.RandomBytes(16))};
}

}  // namespace terra::chaos
