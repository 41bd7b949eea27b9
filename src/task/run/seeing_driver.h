// Interface of a simulated hand that acts on what it sees: it is shown each Frame before its next
// movement.
#pragma once

#include "frame/frame.h"
#include "hand/driver.h"

namespace dihaptic::task {

class SeeingDriver : public hand::Driver {
  public:
    /// Shows the hand a tick's Frame. Runs in the tick: neither allocates nor throws. What can be
    /// seen of the Frame is what frame/displayed.h gives.
    void see(const frame::Frame& frame) noexcept { do_see(frame); }
    /// In the tick: the key that the hand has pressed since the last call; 0 if none.
    char take_key() noexcept { return do_take_key(); }
    /// Goes back to the start, for a new run.
    virtual void restart() = 0;

  private:
    virtual void do_see(const frame::Frame& frame) noexcept = 0;
    virtual char do_take_key() noexcept { return 0; }
};

}  // namespace dihaptic::task
