// Interface of a simulated hand that acts on its visual input: it receives each Frame before its
// next movement.
#pragma once

#include "frame/frame.h"
#include "hand/driver.h"

namespace dihaptic::task {

class SeeingDriver : public hand::Driver {
  public:
    /// Shows the hand the Frame of a tick. Runs in the tick: neither allocates nor throws. The
    /// visible part of the Frame is given by frame/displayed.h.
    void see(const frame::Frame& frame) noexcept { do_see(frame); }
    /// The key that the hand has pressed since the last call; 0: none. Runs in the tick.
    char take_key() noexcept { return do_take_key(); }
    /// Returns to the start, for a new run.
    virtual void restart() = 0;

  private:
    virtual void do_see(const frame::Frame& frame) noexcept = 0;
    virtual char do_take_key() noexcept { return 0; }
};

}  // namespace dihaptic::task
