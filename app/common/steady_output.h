// Replaces standard output and standard error with streams to which writing never fails. When their
// reader (a terminal, or the other end of a pipe) is gone, output is discarded and the program is
// asked to end properly.
#pragma once

namespace dihaptic::cli {

/// Must be called once, before any output.
void make_output_steady();

}  // namespace dihaptic::cli
