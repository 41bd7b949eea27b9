// Leads a person on the terminal: prints what to do, and Enter says that it is done.
#pragma once

#include <string>

#include "command.h"
#include "rig/calibration_guide.h"

namespace dihaptic::cli {

class TerminalGuide {
  public:
    /// `label`: of the line of progress. `skip`: what is entered to do without all of it; "": it
    /// cannot be.
    explicit TerminalGuide(const std::string& label, std::string skip = "");

    /// Ctrl-C, the end of input, and `skip` give up.
    rig::Guide guide();

  private:
    void show(const rig::Guidance& now);
    bool done();

    ProgressLine line_;
    std::string skip_;
    int step_ = 0;
};

}  // namespace dihaptic::cli
