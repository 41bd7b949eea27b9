#include "servo/frame.h"

namespace dihaptic::servo {

StatusText describe(Status bit) {
    switch (bit) {
        case kContactsFull:
            return {"more contacts than memory was reserved for",
                    "raise settings: dynamics: max_contacts"};
        case kForceLimited:
            return {"a force or a torque was cut to the largest allowed",
                    "soften the coupling, or press less"};
        case kRateLimited:
            return {"a force or a torque was kept from changing faster than allowed",
                    "soften the coupling, touch more slowly, or raise settings: safety: "
                    "max_force_rate_N_s"};
        case kNotFinite:
            return {"the simulation diverged: a force or a position was not a number",
                    "do not use this session; look for an extreme mass, stiffness or damping, or "
                    "report the session's folder as a bug"};
        case kOutsideWorkspace:
            return {"a handle left its device's workspace",
                    "move the device in the rig file, or the hand"};
        case kForceClamped:
            return {"a device was asked for more than its peak force or torque",
                    "lower settings: safety: max_force_N or max_torque_Nm, or soften the coupling"};
        case kNoMoreData:
            return {"the recording ended", ""};
        case kOverrun:
            return {"the tick before had ended too late, and those that it missed were left out",
                    "close other programs, lower the rate, or allow real time where a note asks "
                    "for it"};
        case kSolverFallback:
            return {
                "the contact solver missed its tolerance and another answered",
                "nothing, when it is rare; otherwise choose settings: dynamics: solver: newton"};
        case kForceOff:
            return {"force was off, after a fault", "look at the first fault"};
        case kBadReading:
            return {"a device gave a position or a velocity that is not a number",
                    "look at its cables and its calibration"};
        case kNotAnswering:
            return {"a device did not answer", "look at its power and its cables"};
        case kTooFast:
            return {"a handle jumped, or turned or moved faster than allowed",
                    "look at the device's cables and encoders, or raise settings: safety: "
                    "max_speed_m_s"};
        case kLate:
            return {"the hands were left without an answer for longer than allowed",
                    "close other programs, or look for a device that blocks"};
        case kKeepsLate:
            return {"ticks came late again and again",
                    "close other programs, or lower the rate or the stiffness"};
        case kSoftened:
            return {
                "the coupling was softened to what can be rendered calmly at the rate that the "
                "loop kept",
                "close other programs, or lower the rate"};
        case kAbandoned:
            return {"the window did not answer any more", "close other programs"};
        case kHeatLimited:
            return {"a force or a torque was cut to what the device's motors can bear for long",
                    "press less, or for shorter; the force comes back as they cool"};
        case kPushedInward:
            return {"a handle was pushed back into its device's workspace",
                    "move the device in the rig file, or the hand"};
        case kSoftStarted:
            return {"a force was still rising, as it does when it comes on",
                    "nothing; let the handles touch nothing when a session starts"};
        case kSwitchedOff:
            return {"force was off: nobody held the dead-man switch",
                    "hold it, or look at settings: safety: dead_man_finger and dead_man_button"};
        case kEnergyGenerated:
            return {"a coupling gave a hand energy that nobody had put in",
                    "soften it, raise its damping, or set settings: safety: energy_guard: act"};
        case kEnergyDamped:
            return {"a damper took of that energy", "soften the coupling, or raise its damping"};
        case kPaused:
            return {"the session paused, and force was off", ""};
        case kResumed:
            return {"the session went on after a pause", "nothing"};
        case kForceDropped:
            return {
                "a device took its force away for a moment: a force, a speed or a heat was beyond "
                "what it bears",
                "soften the coupling, move more slowly, or let its motors cool"};
        case kUncalibrated:
            return {"a device lost its calibration", "calibrate it as its maker says"};
        case kDeviceFault:
            return {"a device reported a fault of its own", "let it cool, switch it off and on"};
        case kStopped:
            return {"the operator switched force off", ""};
        case kSolverMissed:
            return {"the contact solver missed its tolerance, and the best answer was used",
                    "nothing with sequential_impulse, which ends near the answer, or in a heap; "
                    "otherwise look at what the objects do in these ticks, and report the "
                    "session's folder as a bug"};
    }
    return {};
}

}  // namespace dihaptic::servo
