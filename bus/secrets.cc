#include "bus/secrets.h"

#include <cstdlib>
#include <cstring>

#include <sys/resource.h>

namespace terra::bus {

void ForgetApiKeys() {
  for (const char* variable : kApiKeyVariables) {
    if (char* value = std::getenv(variable)) {
      explicit_bzero(value, std::strlen(value));
    }
  }
}

void LeaveNoCore() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
}

}  // namespace terra::bus
