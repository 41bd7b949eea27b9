// Replaces standard output and error by streams to which writing never fails. When their reader (a
// terminal, or the other end of a pipe) is gone, output is lost and the program is asked to stop
// properly.
#pragma once

namespace dihaptic::cli {

/// Call it once, before any output.
void make_output_steady();

}  // namespace dihaptic::cli
