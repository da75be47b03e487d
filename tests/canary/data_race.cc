// Two threads write one variable without a lock: ThreadSanitizer must stop it.
#include <thread>

int main() {
  int shared = 0;
  std::thread other([&shared] {
    for (int i = 0; i < 10'000; ++i) {
      shared = i;
      asm volatile("" : : "g"(&shared) : "memory");
    }
  });
  for (int i = 0; i < 10'000; ++i) {
    shared = -i;
    asm volatile("" : : "g"(&shared) : "memory");
  }
  other.join();
  return 0;
}
