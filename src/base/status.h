// A table of the problems that a tick can report and of the faults that switch force off. Devices,
// haptics and the Frame use the same bits.
#pragma once

#include <bit>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>

namespace dihaptic {

/// A bit in the status of a tick or of a device's reading. Logs contain these numbers, so a bit
/// never changes its meaning.
enum Status : uint32_t {
    kContactsFull = 1u << 0,
    kForceLimited = 1u << 1,
    kRateLimited = 1u << 2,
    kNotFinite = 1u << 3,
    kOutsideWorkspace = 1u << 4,
    kForceClamped = 1u << 5,
    kNoMoreData = 1u << 6,
    kOverrun = 1u << 7,
    kSolverFallback = 1u << 8,
    kSolverMissed = 1u << 9,
    kForceOff = 1u << 10,
    kBadReading = 1u << 11,
    kNotAnswering = 1u << 12,
    kTooFast = 1u << 13,
    kLate = 1u << 14,
    kHeatLimited = 1u << 15,
    kPushedInward = 1u << 16,
    kSoftStarted = 1u << 17,
    kSwitchedOff = 1u << 18,
    kEnergyGenerated = 1u << 19,
    kEnergyDamped = 1u << 20,
    kStopped = 1u << 21,
    kResumed = 1u << 22,
    kForceDropped = 1u << 23,
    kUncalibrated = 1u << 24,
    kDeviceFault = 1u << 25,
    kKeepsLate = 1u << 26,
    kSoftened = 1u << 27,
    kAbandoned = 1u << 28,
    kPaused = 1u << 29,
    kUnbalanced = 1u << 30,
    kHeldBack = 1u << 31,
};

/// The bits that devices set in their readings.
constexpr uint32_t kStatusByDevice = kOutsideWorkspace | kForceClamped | kNoMoreData |
                                     kNotAnswering | kForceDropped | kUncalibrated | kDeviceFault;

/// The reason why force was switched off; the table below has a sentence for each.
enum class FaultKind {
    none,
    bad_reading,
    not_answering,
    uncalibrated,
    device_fault,
    too_fast,
    turned_too_fast,
    late,
    keeps_late,
    not_finite,
    diverged,
    active,
    chatters,
    abandoned,
    stopped
};

/// The sentence that describes a fault; haptics::describe() fills in the names in braces.
struct FaultText {
    FaultKind kind = FaultKind::none;
    std::string_view what{};
    std::string_view remedy{};  ///< if empty, the remedy of the status applies
};

struct StatusRow {
    Status bit;
    std::string_view what;
    std::string_view remedy;  ///< empty if there is none
    /// The faults that can occur with this status. If there are none, the status leaves force on.
    FaultText faults[2] = {};
};

constexpr StatusRow kStatusTable[] = {
    {kContactsFull, "more contacts than the reserved memory can hold",
     "raise settings: dynamics: max_contacts"},
    {kForceLimited, "a force or a torque was cut to the largest allowed",
     "soften the coupling, or press less hard"},
    {kRateLimited, "a force or a torque was kept from changing faster than allowed",
     "soften the coupling, touch more slowly, or raise settings: safety: max_force_rate_N_s"},
    {kNotFinite,
     "the simulation diverged: a force or a position was not a number",
     "do not use this session; look for an extreme mass, stiffness or damping, or report the "
     "session's folder as a bug",
     {{FaultKind::not_finite, "{for_finger}a computed force is not a number"},
      {FaultKind::diverged,
       "the simulation diverged: the position or velocity of a body is not a number"}}},
    {kOutsideWorkspace, "a handle left its device's workspace",
     "move the device in the rig file, or the hand"},
    {kForceClamped, "more than a device's peak force or torque was requested",
     "lower settings: safety: max_force_N or max_torque_Nm, or soften the coupling"},
    {kNoMoreData, "the recording ended", ""},
    {kOverrun, "the previous tick ended too late, and the ticks that it missed were left out",
     "close other programs, lower the rate, or allow real time if a note asks for it"},
    {kSolverFallback, "the contact solver missed its tolerance, and another solver answered",
     "nothing if this is rare or in a heap; otherwise choose settings: dynamics: solver: "
     "newton"},
    {kSolverMissed, "the contact solver missed its tolerance, and the best answer was used",
     "nothing with sequential_impulse, which ends near the answer, or in a heap that no finger "
     "touches (solver_held_residual); where solver_route is out_of_work, the step had more "
     "contacts "
     "than a tick has time for: use fewer objects, or objects that do not start inside each other; "
     "otherwise check the objects' motion in these ticks, and report the session's folder as a "
     "bug"},
    {kForceOff, "force was off, after a fault", "see the first fault"},
    {kBadReading,
     "a device reported a position or velocity that is not a number",
     "check its cables and its calibration",
     {{FaultKind::bad_reading, "{device}reported a position or velocity that is not a number"}}},
    {kNotAnswering,
     "a device did not answer",
     "check its power and its cables",
     {{FaultKind::not_answering, "{device}does not answer"}}},
    {kTooFast,
     "a handle jumped, or turned or moved faster than allowed",
     "check the device's cables and encoders, or raise settings: safety: max_speed_m_s",
     {{FaultKind::too_fast, "{device}moved at {value:.3g} m/s, but only {limit:g} m/s are allowed",
       "if no hand did that, check its cables and encoders; otherwise raise settings: safety: "
       "max_speed_m_s"},
      {FaultKind::turned_too_fast,
       "{device}turned at {value:.3g} rad/s, but only {limit:g} rad/s are allowed",
       "check its cables and the encoders of its gimbal"}}},
    {kLate,
     "the hands received no new force for longer than allowed",
     "close other programs, or look for a device that blocks",
     {{FaultKind::late,
       "the hands received no new force for {value_ms:.0f} ms, but only {limit_ms:g} ms are "
       "allowed"}}},
    {kHeatLimited, "a force or a torque was cut to a level that the device's motors can sustain",
     "press less hard, or for less time; the force returns as the motors cool"},
    {kPushedInward, "a handle was pushed back into its device's workspace",
     "move the device in the rig file, or the hand"},
    {kSoftStarted, "a force was still rising after being switched on",
     "nothing; let the handles touch nothing when a session starts"},
    {kSwitchedOff, "force was off: nobody held the dead-man switch",
     "hold it, or check settings: safety: dead_man_finger and dead_man_button"},
    {kEnergyGenerated,
     "a coupling gave a hand more energy than had been put in",
     "soften the coupling, raise its damping, give its body more mass, or set settings: safety: "
     "energy_guard: act",
     {{FaultKind::active,
       "{of_finger}coupling kept feeding energy into the hand, {value:.2g} J more than was put "
       "in"},
      {FaultKind::chatters,
       "{of_finger}force kept alternating from tick to tick, by {value:.1f} N"}}},
    {kEnergyDamped, "a damper removed some of that energy",
     "soften the coupling, or raise its damping"},
    {kStopped,
     "the operator switched force off",
     "",
     {{FaultKind::stopped, "it was stopped by the operator", "everything until then is recorded"}}},
    {kResumed, "the session went on after a pause", "nothing"},
    {kForceDropped,
     "a device dropped its force for a moment: a force, a speed or a temperature exceeded its "
     "limits",
     "soften the coupling, move more slowly, or let its motors cool"},
    {kUncalibrated,
     "a device lost its calibration",
     "calibrate it as its manual describes",
     {{FaultKind::uncalibrated, "{device}lost its calibration"}}},
    {kDeviceFault,
     "a device reported a fault of its own",
     "let it cool, switch it off and on",
     {{FaultKind::device_fault, "{device}reports a fault of its own"}}},
    {kKeepsLate,
     "ticks kept coming late",
     "close other programs, or lower the rate or the stiffness",
     {{FaultKind::keeps_late,
       "so many ticks came late, {value_ms:.0f} ms on average, that not even {limit:g} N/m could "
       "be rendered calmly",
       "close other programs, or lower the rate"}}},
    {kSoftened,
     "the coupling was softened to a stiffness that can be rendered calmly at the loop's actual "
     "rate",
     "close other programs, or lower the rate"},
    {kAbandoned,
     "the window no longer answered",
     "close other programs",
     {{FaultKind::abandoned, "the window has not answered for {value:.1f} s"}}},
    {kPaused, "the session paused, and force was off", ""},
    {kUnbalanced,
     "the energy or the momentum of the objects changed by more than the forces on them explain",
     "do not trust the objects' motion in these ticks: see energy_imbalance, momentum_imbalance "
     "and angular_imbalance; let no object start inside another, turn by an eighth of a turn "
     "in a tick, or hang on a spring that is too stiff for its mass; otherwise report the "
     "session's folder "
     "as a bug"},
    {kHeldBack, "an object moved less than its velocity implies, so as not to enter another object",
     "nothing if this is rare; otherwise use fewer, slower or thicker objects"},
};
constexpr int kStatusBits = static_cast<int>(std::size(kStatusTable));
constexpr auto kAllStatus = static_cast<uint32_t>((uint64_t{1} << kStatusBits) - 1);

/// The row of the table for one bit.
constexpr const StatusRow& describe(Status bit) noexcept {
    return kStatusTable[std::countr_zero(static_cast<uint32_t>(bit))];
}
static_assert([] {
    for (const StatusRow& row : kStatusTable) {
        if (&describe(row.bit) != &row) return false;
    }
    return true;
}());

/// Calls `use` with each Status bit that is set, lowest bit first. Bits that are defined only in
/// later versions are ignored.
template <class Use>
void for_each_status(uint32_t status, Use use) {
    for (uint32_t left = status & kAllStatus; left != 0; left &= left - 1)
        use(static_cast<Status>(left & ~(left - 1)));
}
/// The sentences for all the bits that are set, separated by "; ".
std::string words(uint32_t status);

/// The row that contains a fault; null if there is none.
constexpr const StatusRow* row_of(FaultKind kind) noexcept {
    if (kind == FaultKind::none) return nullptr;
    for (const StatusRow& row : kStatusTable) {
        if (row.faults[0].kind == kind || row.faults[1].kind == kind) return &row;
    }
    return nullptr;
}

}  // namespace dihaptic
