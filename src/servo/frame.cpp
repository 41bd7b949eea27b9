#include "servo/frame.h"

#include <iterator>

namespace dihaptic::servo {
namespace {

struct StatusRow {
    Status bit;
    const char* what;
    const char* remedy;
};

constexpr StatusRow kStatusRows[] = {
    {kContactsFull, "more contacts than memory was reserved for",
     "raise settings: dynamics: max_contacts"},
    {kForceLimited, "a force or a torque was cut to the largest allowed",
     "soften the coupling, or press less"},
    {kRateLimited, "a force or a torque was kept from changing faster than allowed",
     "soften the coupling, touch more slowly, or raise settings: safety: max_force_rate_N_s"},
    {kNotFinite, "the simulation diverged: a force or a position was not a number",
     "do not use this session; look for an extreme mass, stiffness or damping, or report the "
     "session's folder as a bug"},
    {kOutsideWorkspace, "a handle left its device's workspace",
     "move the device in the rig file, or the hand"},
    {kForceClamped, "a device was asked for more than its peak force or torque",
     "lower settings: safety: max_force_N or max_torque_Nm, or soften the coupling"},
    {kNoMoreData, "the recording ended", ""},
    {kOverrun, "the tick before had ended too late, and those that it missed were left out",
     "close other programs, lower the rate, or allow real time where a note asks for it"},
    {kSolverFallback, "the contact solver missed its tolerance and another answered",
     "nothing, when it is rare; otherwise choose settings: dynamics: solver: newton"},
    {kSolverMissed, "the contact solver missed its tolerance, and the best answer was used",
     "nothing with sequential_impulse, which ends near the answer, or in a heap; otherwise look at "
     "what the objects do in these ticks, and report the session's folder as a bug"},
    {kForceOff, "force was off, after a fault", "look at the first fault"},
    {kBadReading, "a device gave a position or a velocity that is not a number",
     "look at its cables and its calibration"},
    {kNotAnswering, "a device did not answer", "look at its power and its cables"},
    {kTooFast, "a handle jumped, or turned or moved faster than allowed",
     "look at the device's cables and encoders, or raise settings: safety: max_speed_m_s"},
    {kLate, "the hands were left without an answer for longer than allowed",
     "close other programs, or look for a device that blocks"},
    {kHeatLimited, "a force or a torque was cut to what the device's motors can bear for long",
     "press less, or for shorter; the force comes back as they cool"},
    {kPushedInward, "a handle was pushed back into its device's workspace",
     "move the device in the rig file, or the hand"},
    {kSoftStarted, "a force was still rising, as it does when it comes on",
     "nothing; let the handles touch nothing when a session starts"},
    {kSwitchedOff, "force was off: nobody held the dead-man switch",
     "hold it, or look at settings: safety: dead_man_finger and dead_man_button"},
    {kEnergyGenerated, "a coupling gave a hand energy that nobody had put in",
     "soften it, raise its damping, or set settings: safety: energy_guard: act"},
    {kEnergyDamped, "a damper took of that energy", "soften the coupling, or raise its damping"},
    {kStopped, "the operator switched force off", ""},
    {kResumed, "the session went on after a pause", "nothing"},
    {kForceDropped,
     "a device took its force away for a moment: a force, a speed or a heat was beyond what it "
     "bears",
     "soften the coupling, move more slowly, or let its motors cool"},
    {kUncalibrated, "a device lost its calibration", "calibrate it as its maker says"},
    {kDeviceFault, "a device reported a fault of its own", "let it cool, switch it off and on"},
    {kKeepsLate, "ticks came late again and again",
     "close other programs, or lower the rate or the stiffness"},
    {kSoftened,
     "the coupling was softened to what can be rendered calmly at the rate that the loop kept",
     "close other programs, or lower the rate"},
    {kAbandoned, "the window did not answer any more", "close other programs"},
    {kPaused, "the session paused, and force was off", ""},
};
static_assert(std::size(kStatusRows) == kStatusBits);

}  // namespace

StatusText describe(Status bit) {
    for (const StatusRow& row : kStatusRows) {
        if (row.bit == bit) return {row.what, row.remedy};
    }
    return {};
}

std::string words(uint32_t status) {
    std::string out;
    for_each_status(status, [&](Status bit) {
        if (!out.empty()) out += "; ";
        out += describe(bit).what;
    });
    return out;
}

}  // namespace dihaptic::servo
