#include "haptics/safety.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace dihaptic::haptics {
namespace {

/// Whether all values are numbers, and the orientation is one.
bool is_sound(const Handle& read) noexcept {
    constexpr double kUnit = 1e-3;
    return read.p_WH.allFinite() && read.v_WH.allFinite() && read.w_WH.allFinite() &&
           std::abs(read.R_WH.squaredNorm() - 1) < kUnit;
}

/// Judges a reading of a handle that was at `last` a time `elapsed` ago [s]; 0: it was not seen
/// before.
void judge_motion(const Handle& read, const Handle& last, double elapsed, double max_speed,
                  Fault& fault) noexcept {
    double speed = read.v_WH.norm();
    if (elapsed > 0) speed = std::max(speed, (read.p_WH - last.p_WH).norm() / elapsed);
    // written so that a speed that is infinite or NaN fails, too
    if (!(speed <= max_speed)) {
        fault.kind = FaultKind::too_fast;
        fault.value = speed;
        fault.limit = max_speed;
        return;
    }
    double turning = read.w_WH.norm();
    if (elapsed > 0 && read.R_WH.coeffs() != last.R_WH.coeffs())
        turning = std::max(turning, angle_between(read.R_WH, last.R_WH) / elapsed);
    if (!(turning <= kMostTurning)) {
        fault.kind = FaultKind::turned_too_fast;
        fault.value = turning;
        fault.limit = kMostTurning;
    }
}

/// What describe() says; the names in braces are its arguments.
struct FaultText {
    FaultKind kind;
    const char* what;
    const char* remedy;
};

constexpr const char* kExtreme =
    "Look for an extreme mass, stiffness or damping, or report the session's folder as a bug.";
constexpr const char* kSofter =
    "Soften the coupling, raise its damping, or give its body more mass.";

constexpr FaultText kFaultTexts[] = {
    {FaultKind::bad_reading, "{device}gave a position or a velocity that is not a number",
     "Look at its cables and its calibration."},
    {FaultKind::not_answering, "{device}does not answer", "Look at its power and its cables."},
    {FaultKind::uncalibrated, "{device}lost its calibration", "Calibrate it as its maker says."},
    {FaultKind::device_fault, "{device}reports a fault of its own",
     "Let it cool, switch it off and on."},
    {FaultKind::too_fast, "{device}moved at {value:.3g} m/s, and {limit:g} m/s are allowed",
     "If no hand did that, look at its cables and encoders; otherwise raise settings: safety: "
     "max_speed_m_s."},
    {FaultKind::turned_too_fast,
     "{device}turned at {value:.3g} rad/s, and {limit:g} rad/s are allowed",
     "Look at its cables and the encoders of its gimbal."},
    {FaultKind::late,
     "nothing answered the hands for {value_ms:.0f} ms, and {limit_ms:g} ms are allowed",
     "Close other programs, or look for a device that blocks."},
    {FaultKind::keeps_late,
     "so many ticks came late, {value_ms:.0f} ms on average, that not even {limit:g} N/m could be "
     "rendered calmly",
     "Close other programs, or lower the rate."},
    {FaultKind::not_finite, "{for_finger}a force was computed that is not a number", kExtreme},
    {FaultKind::diverged,
     "the simulation diverged: the place or the speed of a body is not a number", kExtreme},
    {FaultKind::active,
     "{of_finger}coupling went on feeding energy into the hand, {value:.2g} J more than was put in",
     kSofter},
    {FaultKind::chatters,
     "{of_finger}force went on alternating from tick to tick, by {value:.1f} N", kSofter},
    {FaultKind::abandoned, "the window has not answered for {value:.1f} s",
     "Close other programs."},
    {FaultKind::stopped, "it was stopped by the operator", "What was done until then is recorded."},
};
static_assert(std::size(kFaultTexts) == static_cast<size_t>(FaultKind::stopped));

constexpr FaultText kClockWentBack{FaultKind::late, "the clock went back by {back_ms:.3g} ms",
                                   "Report it as a bug, with the session's folder."};

const FaultText& text_of(const Fault& fault) {
    if (fault.kind == FaultKind::late && fault.value < 0) return kClockWentBack;
    return *std::find_if(std::begin(kFaultTexts), std::end(kFaultTexts),
                         [&](const FaultText& text) { return text.kind == fault.kind; });
}

}  // namespace

Handle HandleGuard::accept(const Handle& read, FaultKind reported, double elapsed,
                           Fault& fault) noexcept {
    if (trusted_ && reported != FaultKind::none) {
        fault.kind = reported;
    } else if (trusted_ && !is_sound(read)) {
        fault.kind = FaultKind::bad_reading;
    } else if (trusted_) {
        judge_motion(read, last_, seen_ ? elapsed : 0, max_speed_, fault);
    }
    if (fault) trusted_ = false;
    if (!trusted_) {
        last_.v_WH.setZero();
        last_.w_WH.setZero();
        return last_;
    }
    last_ = read;
    seen_ = true;
    return last_;
}

std::string describe(const Fault& fault, const std::string& finger, const std::string& model) {
    if (!fault) return "";
    const FaultText& text = text_of(fault);
    const bool everywhere = fault.device < 0;
    const auto of_one = [&](const std::string& whose) { return everywhere ? "" : whose; };
    const std::string what = fmt::format(
        fmt::runtime(text.what),
        fmt::arg("device", of_one(fmt::format("the {}'s device ({}) ", finger, model))),
        fmt::arg("for_finger", of_one(fmt::format("for the {} ", finger))),
        fmt::arg("of_finger", of_one(fmt::format("the {}'s ", finger))),
        fmt::arg("value", fault.value), fmt::arg("limit", fault.limit),
        fmt::arg("value_ms", fault.value * 1e3), fmt::arg("limit_ms", fault.limit * 1e3),
        fmt::arg("back_ms", -fault.value * 1e3));
    return fmt::format("force is off since {:.3f} s: {}. {}", seconds(fault.time), what,
                       text.remedy);
}

}  // namespace dihaptic::haptics
