#include "base/secrets.h"

#include <cstdlib>
#include <cstring>

#include <sys/prctl.h>
#include <sys/resource.h>

namespace terra {

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

void ForbidTracing() {
  prctl(PR_SET_DUMPABLE, 0);
}

}  // namespace terra
