#include "benchmark/sha256.h"

#include <array>

#include <openssl/evp.h>

#include "terrain/require.h"

namespace terra::benchmark {

std::string Sha256Hex(std::string_view bytes) {
  std::array<unsigned char, 32> digest{};
  TERRA_REQUIRE(EVP_Digest(bytes.data(), bytes.size(), digest.data(), nullptr,
                           EVP_sha256(), nullptr) == 1);
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

}  // namespace terra::benchmark
