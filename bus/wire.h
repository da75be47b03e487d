#pragma once

#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bus/channels.h"
#include "bus/message_schema.h"
#include "terrain/result.h"

namespace terra::bus {

/// Checks encoded bytes before generated code may see them: the fingerprint,
/// every count against its limit and the bytes left, every string's length and
/// end, and that nothing is left over. Generated decode aborts or allocates
/// without bound on bytes that break these rules.
///
/// A layout lists the fields in order, blanks are free: l int64, i int32,
/// h int16, b int8 or byte, d double, s string, s63 a string of at most 63
/// bytes; N512 is a count (int32) of at most 512, and N one of at most the
/// bytes that follow it; a star after a field repeats it by the last count.
Status CheckLayout(std::string_view layout, std::int64_t fingerprint,
                   std::span<const std::uint8_t> bytes);

/// Decodes a message that anybody may have sent.
template <typename T>
Result<T> Decode(std::span<const std::uint8_t> bytes) {
  const Status checked =
      CheckLayout(MessageTraits<T>::kLayout, T::getHash(), bytes);
  if (!checked) return checked.error();
  try {
    T message;
    const int size = static_cast<int>(bytes.size());
    if (message.decode(bytes.data(), 0, size) != size) {
      return Error{ErrorCode::kInvalid, "the message does not decode"};
    }
    return message;
  } catch (const std::exception& problem) {
    return Error{ErrorCode::kInvalid, problem.what()};
  }
}

/// Encodes a message of our own.
/// Pre: every count field equals the size of its vectors, and every limit of
///      the layout is kept (checked after encoding).
template <typename T>
std::vector<std::uint8_t> Encode(const T& message) {
  std::vector<std::uint8_t> bytes(
      static_cast<std::size_t>(message.getEncodedSize()));
  const int size = static_cast<int>(bytes.size());
  TERRA_REQUIRE(message.encode(bytes.data(), 0, size) == size);
  TERRA_REQUIRE(
      CheckLayout(MessageTraits<T>::kLayout, T::getHash(), bytes).ok());
  return bytes;
}

/// Returns a text that may stand in a message: valid UTF-8 of at most so many
/// bytes, cut between characters. Each byte that is no UTF-8 and each control
/// character but tab and line breaks becomes U+FFFD, so that a reader sees that
/// something was there.
std::string CleanText(std::string_view text, std::size_t max_bytes);

/// The same for a name or an error: tabs and line breaks become blanks.
std::string CleanLine(std::string_view text, std::size_t max_bytes);

}  // namespace terra::bus
