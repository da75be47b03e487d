// Loaded in front of the C library: fdatasync(2) does not return while the file
// named by TERRA_STUCK_DISK exists.
#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>

extern "C" int fdatasync(int fd) {
  const char* const stuck = std::getenv("TERRA_STUCK_DISK");
  while (stuck != nullptr && access(stuck, F_OK) == 0) usleep(5'000);
  static const auto real =
      reinterpret_cast<int (*)(int)>(dlsym(RTLD_NEXT, "fdatasync"));
  return real(fd);
}
