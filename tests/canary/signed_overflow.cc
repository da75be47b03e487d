// Overflows a signed integer: UndefinedBehaviorSanitizer must stop it.
#include <limits>

int main(int argc, char**) {
  volatile int value = std::numeric_limits<int>::max();
  value = value + argc;
  return 0;
}
