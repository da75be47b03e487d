#include "advisor/fingerprint.h"

#include <xxhash.h>

#include <array>
#include <new>

namespace terra::advisor {

struct Fingerprint::State {
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> xxh{XXH3_createState()};
};

Fingerprint::Fingerprint() : state_(std::make_unique<State>()) {
  if (state_->xxh == nullptr) {
    throw std::bad_alloc();
  }
  XXH3_128bits_reset(state_->xxh.get());
}

Fingerprint::~Fingerprint() = default;

void Fingerprint::Add(std::int64_t value) {
  std::array<std::uint8_t, 8> bytes{};
  auto bits = static_cast<std::uint64_t>(value);
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(bits);
    bits >>= 8;
  }
  AddBytes(bytes.data(), bytes.size());
}

void Fingerprint::Add(std::string_view text) {
  Add(static_cast<std::int64_t>(text.size()));
  AddBytes(text.data(), text.size());
}

void Fingerprint::AddBytes(const void* data, std::size_t size) {
  if (size > 0) {
    XXH3_128bits_update(state_->xxh.get(), data, size);
  }
}

std::string Fingerprint::Hex() const {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_->xxh.get()));
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string hex;
  for (const unsigned char byte : canonical.digest) {
    hex += kDigits[byte >> 4];
    hex += kDigits[byte & 15];
  }
  return hex;
}

}  // namespace terra::advisor
