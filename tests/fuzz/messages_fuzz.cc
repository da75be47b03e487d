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
  Check<terra_msg::deployed_t>(bytes);
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

using Checker = void (*)(std::span<const std::uint8_t>);
constexpr Checker kCheckers[] = {
    Check<terra_msg::map_header_t>,  Check<terra_msg::map_tile_t>,
    Check<terra_msg::map_request_t>, Check<terra_msg::plan_request_t>,
    Check<terra_msg::baseline_t>,    Check<terra_msg::advice_t>,
    Check<terra_msg::verdict_t>,     CheckChain,
    Check<terra_msg::pose_t>,        Check<terra_msg::status_t>,
    Check<terra_msg::config_t>,      Check<terra_msg::log_mark_t>,
    Check<terra_msg::gate_step_t>,
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  kCheckers[data[0] % std::size(kCheckers)]({data + 1, size - 1});
  return 0;
}
