// Vectors of kLanes cells, for the sweep's kernels: to be included by them
// alone (sweep_kernel.h says why all is in an unnamed namespace).

#include <cstdint>
#include <utility>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace terra {
namespace {

// Signed, because SSE2 and AVX2 compare no others; keys leave room for the
// sign.
using Lanes [[gnu::vector_size(4 * kLanes)]] = std::int32_t;
using Codes [[gnu::vector_size(2 * kLanes)]] = std::uint16_t;

template <typename Vector, typename Element>
Vector Load(const Element* from) {
  Vector lanes;
  __builtin_memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

void Store(std::uint32_t* to, Lanes lanes) {
  __builtin_memcpy(to, &lanes, sizeof(lanes));
}

Lanes Splat(std::uint32_t value) {
  return Lanes{} + static_cast<std::int32_t>(value);
}

Lanes Min(Lanes a, Lanes b) {
  return a < b ? a : b;
}
Lanes Max(Lanes a, Lanes b) {
  return a < b ? b : a;
}

// Whether a is below b in any lane.
bool AnyBelow(Lanes a, Lanes b) {
#if defined(__AVX512F__)
  return _mm512_cmplt_epi32_mask(reinterpret_cast<__m512i>(a),
                                 reinterpret_cast<__m512i>(b)) != 0;
#elif defined(__AVX2__)
  return _mm256_movemask_epi8(reinterpret_cast<__m256i>(a < b)) != 0;
#elif defined(__SSE2__)
  return _mm_movemask_epi8(reinterpret_cast<__m128i>(a < b)) != 0;
#else
  const auto below = a < b;
  bool any = false;
  for (int i = 0; i < kLanes; ++i) {
    any = any || below[i] != 0;
  }
  return any;
#endif
}

// kLanes lanes of two vectors side by side, from lane kFrom on.
template <int kFrom, int... kLane>
Lanes Window(Lanes west, Lanes east, std::integer_sequence<int, kLane...>) {
#if defined(__clang__)
  return __builtin_shufflevector(west, east, (kFrom + kLane)...);
#else
  // g++ 11 has only this one; g++ makes the same instructions of both.
  return __builtin_shuffle(west, east, Lanes{(kFrom + kLane)...});
#endif
}

using AllLanes = std::make_integer_sequence<int, kLanes>;

// The way along a row in which keys are handed on.
struct East {
  // Lane i gets lane i - kBy; the first kBy lanes get those of `entering`.
  template <int kBy>
  static Lanes Move(Lanes lanes, Lanes entering) {
    return Window<kLanes - kBy>(entering, lanes, AllLanes());
  }
  static constexpr int kStep = 1;
  static constexpr int kLast = kLanes - 1;
};
struct West {
  template <int kBy>
  static Lanes Move(Lanes lanes, Lanes entering) {
    return Window<kBy>(lanes, entering, AllLanes());
  }
  static constexpr int kStep = -1;
  static constexpr int kLast = 0;
};

}  // namespace
}  // namespace terra
