// Standard output and error of which no writing fails. When whoever reads them is gone (a pipe's
// other end, a terminal), what is said goes nowhere, and the program is asked to stop in order.
#pragma once

namespace dihaptic::cli {

/// To be called once, before anything is written.
void make_output_steady();

}  // namespace dihaptic::cli
