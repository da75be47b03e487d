#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "terrain/result.h"

/// One input of a fuzz target. A target is a source file that defines this; it
/// is driven by libFuzzer (preset fuzz) or by replay.cc.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size);

namespace terra::fuzz {

/// What must hold for every input; else the input is reported as a crash.
inline void Require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// For a reader whose value says nothing more: what it refuses, it gives a
/// reason for.
template <typename T>
void RequireReason(const Result<T>& result) {
  Require(result.ok() || !result.error().message.empty(), "a refusal says why");
}

inline std::string_view Text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace terra::fuzz
