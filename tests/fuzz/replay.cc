// Drives a fuzz target without libFuzzer: every file of a corpus, and as many
// seeded mutations of each as asked for.
//
// usage: fuzz_TARGET CORPUS_FOLDER [MUTATIONS_PER_FILE]

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz.h"

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes ReadFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(file), {});
}

class Mutator {
 public:
  // Bytes changed, repeated and cut; a piece taken from elsewhere.
  Bytes Mutate(Bytes bytes) {
    for (std::size_t n = 1 + Below(4); n > 0 && !bytes.empty(); --n) {
      const std::size_t at = Below(bytes.size());
      switch (Below(5)) {
        case 0:
          bytes[at] ^= static_cast<std::uint8_t>(1u << Below(8));
          break;
        case 1:
          bytes[at] = kTelling[Below(std::size(kTelling))];
          break;
        case 2:
          bytes.resize(at);
          break;
        case 3:
          bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                       1 + Below(16), bytes[at]);
          break;
        default: {
          const std::size_t from = Below(bytes.size());
          const Bytes piece(
              bytes.begin() + static_cast<std::ptrdiff_t>(from),
              bytes.begin() + static_cast<std::ptrdiff_t>(std::min(
                                  bytes.size(), from + 1 + Below(32))));
          bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                       piece.begin(), piece.end());
        }
      }
    }
    return bytes;
  }

 private:
  static constexpr std::uint8_t kTelling[] = {0,    1,   0x7f, 0x80, 0xff, '\n',
                                              '\r', ' ', '"',  ',',  '(',  ')',
                                              '[',  ']', '-',  '9',  '0',  '.'};

  std::size_t Below(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_);
  }

  std::mt19937_64 random_{1};
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const int mutations = argc > 2 ? std::stoi(argv[2]) : 0;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  Mutator mutator;
  std::size_t inputs = 0;
  for (const std::filesystem::path& path : files) {
    const Bytes bytes = ReadFile(path);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    for (int i = 0; i < mutations; ++i) {
      const Bytes mutated = mutator.Mutate(bytes);
      LLVMFuzzerTestOneInput(mutated.data(), mutated.size());
    }
    inputs += 1 + static_cast<std::size_t>(mutations);
  }
  std::cout << files.size() << " files, " << inputs << " inputs\n";
  return files.empty() ? 1 : 0;
}
