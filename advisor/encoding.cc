#include "advisor/encoding.h"

#include <zstd.h>

#include <array>

#include <openssl/evp.h>

#include "terrain/require.h"

namespace terra::advisor {
std::string Sha256Hex(std::string_view bytes) {
  Sha256 digest;
  digest.Add(bytes);
  return digest.Hex();
}

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
  TERRA_REQUIRE(context_ != nullptr);
  TERRA_REQUIRE(EVP_DigestInit_ex(context_, EVP_sha256(), nullptr) == 1);
}

Sha256::~Sha256() {
  EVP_MD_CTX_free(context_);
}

void Sha256::Add(std::string_view bytes) {
  TERRA_REQUIRE(EVP_DigestUpdate(context_, bytes.data(), bytes.size()) == 1);
}

std::string Sha256::Hex() {
  std::array<unsigned char, 32> digest{};
  TERRA_REQUIRE(EVP_DigestFinal_ex(context_, digest.data(), nullptr) == 1);
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string hex;
  for (const unsigned char byte : digest) {
    hex += kDigits[byte >> 4];
    hex += kDigits[byte & 15];
  }
  return hex;
}

std::string Compress(std::string_view bytes) {
  std::string compressed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(compressed.data(), compressed.size(), bytes.data(),
                    bytes.size(), ZSTD_maxCLevel());
  TERRA_REQUIRE(ZSTD_isError(size) == 0);
  compressed.resize(size);
  return compressed;
}

std::optional<std::string> Decompress(std::string_view compressed,
                                      std::size_t max_bytes) {
  std::string bytes(max_bytes, '\0');
  const std::size_t size = ZSTD_decompress(
      bytes.data(), bytes.size(), compressed.data(), compressed.size());
  if (ZSTD_isError(size) != 0) {
    return std::nullopt;
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace terra::advisor
