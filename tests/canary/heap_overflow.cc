// Reads one element past the end of a heap block: AddressSanitizer must stop
// it. The block has room in every plain allocator, so a plain build ends well.
#include <memory>

int main(int argc, char**) {
  const auto block = std::make_unique<volatile char[]>(9);
  volatile char* past_the_end = block.get() + 8 + argc;
  const char seen = *past_the_end;
  return seen == 127 ? 1 : 0;
}
