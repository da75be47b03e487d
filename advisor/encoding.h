#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // Of OpenSSL.

namespace terra::advisor {

/// SHA-256 in 64 hexadecimal digits.
std::string Sha256Hex(std::string_view bytes);

/// The same of bytes that come in parts.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void Add(std::string_view bytes);
  /// Of all that was added; once.
  std::string Hex();

 private:
  evp_md_ctx_st* context_;
};

/// Zstandard. Decompress gives none for damaged input and for more than
/// `max_bytes` of content, whatever the header claims.
std::string Compress(std::string_view bytes);
std::optional<std::string> Decompress(std::string_view compressed,
                                      std::size_t max_bytes);

}  // namespace terra::advisor
