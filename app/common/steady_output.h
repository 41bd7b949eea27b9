// Replaces standard output and error by streams to which writing never fails. When their reader (a
// terminal, or the other end of a pipe) is gone, output is lost and the program is asked to stop in
// order.
#pragma once

namespace dihaptic::cli {

/// To be called once, before anything is written.
void make_output_steady();

}  // namespace dihaptic::cli
