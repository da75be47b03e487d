// Logs as many lines as it is told, says on standard output how many of them
// were dropped by then, and ends on SIGUSR1.
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>

#include "bus/log.h"

int main(int argc, char** argv) {
  sigset_t end;
  sigemptyset(&end);
  sigaddset(&end, SIGUSR1);
  sigprocmask(SIG_BLOCK, &end, nullptr);
  const int lines = argc == 2 ? std::atoi(argv[1]) : 0;
  terra::bus::SetLogName("lines");
  for (int i = 0; i < lines; ++i) {
    terra::bus::LogWarning("line " + std::to_string(i));
  }
  std::cout << "dropped " << terra::bus::LogLinesDropped() << std::endl;
  int signal = 0;
  sigwait(&end, &signal);
}
