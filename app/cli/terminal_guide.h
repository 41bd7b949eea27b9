// Guides a person on the terminal: it prints what to do, and Enter confirms that a step is done.
#pragma once

#include <string>

#include "command.h"
#include "rig/calibration_guide.h"

namespace dihaptic::cli {

class TerminalGuide {
  public:
    /// `label`: label of the progress line.
    explicit TerminalGuide(const std::string& label) : line_(label) {}

    /// The guide throws rig::GivenUp at Ctrl-C and at the end of input.
    rig::Guide guide();

  private:
    void show(const rig::Guidance& now);
    bool done();
    /// Reads typed characters, without waiting for the rest of a line. False at the end of input.
    bool read_input();

    ProgressLine line_;
    int step_ = 0;
    std::string typed_;  // input not yet processed
};

}  // namespace dihaptic::cli
