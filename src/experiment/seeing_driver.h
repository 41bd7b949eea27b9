// A simulated hand that acts on what it sees: each Frame is shown to it before it moves on.
#pragma once

#include "hand/driver.h"
#include "servo/frame.h"

namespace dihaptic::experiment {

class SeeingDriver : public hand::Driver {
  public:
    /// After each tick, in it: neither allocates nor throws. What is seen is what servo/displayed.h
    /// says.
    void see(const servo::Frame& frame) noexcept { do_see(frame); }
    /// The key that it has pressed since this was last asked, in the tick; 0: none.
    char take_key() noexcept { return do_take_key(); }
    /// Back to the start: a run begins.
    virtual void restart() = 0;

  private:
    virtual void do_see(const servo::Frame& frame) noexcept = 0;
    virtual char do_take_key() noexcept { return 0; }
};

}  // namespace dihaptic::experiment
