// Sets of a row's blocks, one bit each, lowest bit of the first word = the
// westernmost block: for the sweep's kernels alone (sweep_kernel.h says why all
// is in an unnamed namespace).

#include <cstdint>

namespace terra {
namespace {

using BlockWord = std::uint64_t;
constexpr int kBlocksPerWord = 64;

// No map is wider than 8192 cells (TerrainMap::kMaxSide).
constexpr int kMaxWords = 8192 / kLanes / kBlocksPerWord + 1;

int WordsFor(int num_blocks) {
  return (num_blocks + kBlocksPerWord - 1) / kBlocksPerWord;
}

void AddBlock(BlockWord* set, int block) {
  set[block / kBlocksPerWord] |= BlockWord{1} << block % kBlocksPerWord;
}
bool HasBlock(const BlockWord* set, int block) {
  return (set[block / kBlocksPerWord] >> block % kBlocksPerWord & 1) != 0;
}

// Takes the westernmost block out of word w of a set. Pre: the word is not 0.
int TakeWestmost(BlockWord* set, int w) {
  const int bit = __builtin_ctzll(set[w]);
  set[w] &= set[w] - 1;
  return w * kBlocksPerWord + bit;
}
// The same with the easternmost.
int TakeEastmost(BlockWord* set, int w) {
  const int bit = kBlocksPerWord - 1 - __builtin_clzll(set[w]);
  set[w] ^= BlockWord{1} << bit;
  return w * kBlocksPerWord + bit;
}

// Moves a set to `wider`, where each block has its two neighbours with it, and
// empties it. Returns whether there was anything in it; if not, `wider` is
// not to be used.
bool TakeWithNeighbours(BlockWord* set, int num_blocks, BlockWord* wider) {
  const int num_words = WordsFor(num_blocks);
  BlockWord any = 0;
  BlockWord from_west = 0;
  for (int w = 0; w < num_words; ++w) {
    const BlockWord here = set[w];
    const BlockWord east = w + 1 < num_words ? set[w + 1] : 0;
    wider[w] =
        here | here << 1 | from_west | here >> 1 | east << (kBlocksPerWord - 1);
    from_west = here >> (kBlocksPerWord - 1);
    any |= here;
  }
  if (any == 0) {
    return false;
  }
  for (int w = 0; w < num_words; ++w) {
    set[w] = 0;
  }
  // The last block has no neighbour to the east.
  const int blocks_in_last = (num_blocks - 1) % kBlocksPerWord + 1;
  wider[num_words - 1] &= ~BlockWord{0} >> (kBlocksPerWord - blocks_in_last);
  return true;
}

}  // namespace
}  // namespace terra
