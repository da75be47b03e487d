// An answer.txt in a folder of questions, all the way to the bytes of ADVICE.

#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include "advisor/exchange_client.h"
#include "tests/fuzz/advice_bytes.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/temp_folder.h"

namespace {

namespace fs = std::filesystem;
using namespace terra::advisor;

class Exchange {
 public:
  Exchange() {
    std::cerr.setstate(std::ios::failbit);  // Blank answers are told there.
    Ask(0);  // Writes the question, which has its answer from now on.
    for (const auto& entry : fs::directory_iterator(folder_.Path("exchange"))) {
      if (entry.is_directory()) answer_ = entry.path() / "answer.txt";
    }
    terra::fuzz::Require(!answer_.empty(), "a question has a folder");
  }

  void Answer(std::string_view bytes) {
    std::ofstream(answer_, std::ios::binary) << bytes;
    Ask(0.002);
  }

 private:
  void Ask(double deadline_s) {
    ExchangeOptions options;
    options.folder = folder_.Path("exchange");
    options.deadline_s = deadline_s;
    options.poll_s = 0;
    problem_.Ask(std::make_unique<ExchangeClient>(options), {});
  }

  terra::testing::TempFolder folder_;
  terra::fuzz::AdviceProblem problem_;
  fs::path answer_;
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Exchange exchange;
  exchange.Answer(terra::fuzz::Text(data, size));
  return 0;
}
