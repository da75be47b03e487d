#if defined(__x86_64__)

#include "terrain/sweep_task.h"

namespace terra {
namespace {
constexpr int kLanes = 16;
}  // namespace
}  // namespace terra

#include "terrain/sweep_kernel.h"

void terra::SweepAvx512(SweepTask& task) {
  Sweeper(task).Run();
}

#endif  // defined(__x86_64__)
