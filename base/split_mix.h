#pragma once

#include <cstdint>

namespace terra {

/// Random bits that are the same on every machine and with every library.
/// Source: SplitMix64 (Steele, Lea and Flood 2014).
class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t seed) : state_(seed) {}

  /// Returns 64 random bits.
  std::uint64_t Next() {
    state_ += kGamma;
    return Mix(state_);
  }

  /// As after `n` more calls of Next.
  void Skip(std::uint64_t n) { state_ += n * kGamma; }

  /// Scrambles a number; a bijection.
  static constexpr std::uint64_t Mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

 private:
  static constexpr std::uint64_t kGamma = 0x9e3779b97f4a7c15;

  std::uint64_t state_;
};

}  // namespace terra
