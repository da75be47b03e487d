// Every message type: bytes that decode are exactly the bytes that their values
// encode to. The first byte chooses the type.

#include <algorithm>
#include <span>

#include "bus/codec.h"
#include "bus/messages.h"
#include "tests/fuzz/fuzz.h"

namespace {

template <typename T>
void Check(std::span<const std::uint8_t> bytes) {
  const terra::Result<T> message = terra::bus::Decode<T>(bytes);
  if (!message) return;
  terra::fuzz::Require(std::ranges::equal(terra::bus::Encode(*message), bytes),
                       "decoded bytes are the canonical encoding");
}

void CheckChain(std::span<const std::uint8_t> bytes) {
  const auto message = terra::bus::Decode<terra_msg::deployed_t>(bytes);
  if (!message) return;
  const terra::Cell first{message->start_x, message->start_y};
  const terra::bus::Chain chain{message->num_steps, message->chain};
  const terra::Result<terra::CellPath> cells =
      terra::bus::DecodeChain(first, chain);
  if (!cells) return;
  terra::fuzz::Require(terra::bus::EncodeChain(*cells).bytes == message->chain,
                       "cells encode to the chain they came from");
}

// The check of the type with this number, in order of Channel.
void CheckType(int number, std::span<const std::uint8_t> bytes) {
  int at = 0;
  terra::bus::ForEachMessageType([&]<typename T>() {
    if (at++ == number) Check<T>(bytes);
  });
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  CheckType(data[0] % terra::bus::kNumChannels, {data + 1, size - 1});
  CheckChain({data + 1, size - 1});
  return 0;
}
