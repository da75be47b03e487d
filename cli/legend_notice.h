#pragma once

#include "terrain/files/dataset.h"

namespace terra::cli {

/// Says on stderr that maps of a format with a legend of its own (MovingAI,
/// ROS) are read under the default legend, because the dataset has no
/// legend.csv, and what a ROS map itself has to say. Judged by its first case.
void NoteHowMapsAreRead(const DatasetFolder& dataset);

}  // namespace terra::cli
