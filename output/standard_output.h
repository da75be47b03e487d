#pragma once

#include "terrain/result.h"

namespace terra {

/// Call it first in main. Where a standard stream was closed by who started the
/// program (`>&-`), the next file to be opened would get its number, and what
/// is printed would go into that file. Puts something in its place that cannot
/// be read or written, so that use is an error.
void ReserveStandardStreams();

/// Sends out what std::cout and stdout hold.
/// Errors: something of all that was printed so far could not be written.
Status FlushStandardOutput();

/// Call it last in main: `return FinishStandardOutput("terra", exit_code)`.
/// Says on stderr when output was lost (a full disk, a closed stream), and
/// returns 1 in place of 0 then.
int FinishStandardOutput(const char* program, int exit_code);

}  // namespace terra
