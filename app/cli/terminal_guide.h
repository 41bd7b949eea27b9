// Guides a person on the terminal: prints what to do, and waits for Enter when a step is done.
#pragma once

#include <string>

#include "command.h"
#include "rig/calibration_guide.h"

namespace dihaptic::cli {

class TerminalGuide {
  public:
    /// `label`: label shown in the progress line.
    explicit TerminalGuide(const std::string& label) : line_(label) {}

    /// Returns a guide, which throws rig::GivenUp at Ctrl-C and at the end of input.
    rig::Guide guide();

  private:
    void show(const rig::Guidance& now);
    bool done();
    /// Reads the characters typed so far, without waiting for the end of a line. Returns false at
    /// the end of input.
    bool read_input();

    ProgressLine line_;
    int step_ = 0;
    std::string typed_;  // input that has not been processed yet
};

}  // namespace dihaptic::cli
