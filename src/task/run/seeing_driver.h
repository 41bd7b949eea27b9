// Interface of a simulated hand that acts on visual input: it receives each Frame before its next
// movement.
#pragma once

#include "frame/frame.h"
#include "hand/driver.h"

namespace dihaptic::task {

class SeeingDriver : public hand::Driver {
  public:
    /// Shows the hand the Frame of a tick. Called during a tick, so it does not allocate or throw.
    /// frame/displayed.h gives the visible part of the Frame.
    void see(const frame::Frame& frame) noexcept { do_see(frame); }
    /// Returns the key that the hand has pressed since the last call, or 0 if there is none. Called
    /// during a tick.
    char take_key() noexcept { return do_take_key(); }
    /// Returns the hand to its initial state, for a new run.
    virtual void restart() = 0;

  private:
    virtual void do_see(const frame::Frame& frame) noexcept = 0;
    virtual char do_take_key() noexcept { return 0; }
};

}  // namespace dihaptic::task
