#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace terra::advisor {

/// XXH3-128 (Collet, xxHash) over a sequence of values, the same on every
/// machine: integers go in as 8 little-endian bytes, texts with their length
/// before them, so that no two sequences run into one.
class Fingerprint {
 public:
  Fingerprint();
  ~Fingerprint();
  Fingerprint(const Fingerprint&) = delete;
  Fingerprint& operator=(const Fingerprint&) = delete;

  void Add(std::int64_t value);
  void Add(std::string_view text);
  void AddBytes(const void* data, std::size_t size);

  /// 32 hexadecimal digits of what was added so far.
  std::string Hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace terra::advisor
