#include "terrain/sweep_task.h"

namespace terra {
namespace {
constexpr int kLanes = 4;
}  // namespace
}  // namespace terra

#include "terrain/sweep_kernel.h"

void terra::SweepPortable(SweepTask& task) {
  Sweeper(task).Run();
}
