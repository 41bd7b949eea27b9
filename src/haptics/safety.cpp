#include "haptics/safety.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dihaptic::haptics {
namespace {

/// Numbers, and an orientation that is one.
bool is_sound(const Handle& read) noexcept {
    constexpr double kUnit = 1e-3;
    return read.p_WH.allFinite() && read.v_WH.allFinite() && read.w_WH.allFinite() &&
           std::abs(read.R_WH.squaredNorm() - 1) < kUnit;
}

}  // namespace

Handle HandleGuard::accept(const Handle& read, FaultKind reported, double elapsed,
                           Fault& fault) noexcept {
    if (trusted_ && reported != FaultKind::none) {
        fault.kind = reported;
    } else if (trusted_ && !is_sound(read)) {
        fault.kind = FaultKind::bad_reading;
    } else if (trusted_) {
        double speed = read.v_WH.norm();
        if (seen_ && elapsed > 0)
            speed = std::max(speed, (read.p_WH - last_.p_WH).norm() / elapsed);
        // written so that a speed which overflowed to infinity, or to NaN, fails too
        if (!(speed <= max_speed_)) {
            fault.kind = FaultKind::too_fast;
            fault.value = speed;
            fault.limit = max_speed_;
        }
        double turning = read.w_WH.norm();
        if (seen_ && elapsed > 0 && read.R_WH.coeffs() != last_.R_WH.coeffs())
            turning = std::max(turning, angle_between(read.R_WH, last_.R_WH) / elapsed);
        if (!fault && !(turning <= kMostTurning)) {
            fault.kind = FaultKind::turned_too_fast;
            fault.value = turning;
            fault.limit = kMostTurning;
        }
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
    const std::string which =
        fault.device < 0 ? "" : fmt::format("the {}'s device ({}) ", finger, model);
    std::string what;
    std::string remedy;
    switch (fault.kind) {
        case FaultKind::none:
            return "";
        case FaultKind::bad_reading:
            what = which + "gave a position or a velocity that is not a number";
            remedy = "Look at its cables and its calibration.";
            break;
        case FaultKind::not_answering:
            what = which + "does not answer";
            remedy = "Look at its power and its cables.";
            break;
        case FaultKind::uncalibrated:
            what = which + "lost its calibration";
            remedy = "Calibrate it as its maker says.";
            break;
        case FaultKind::device_fault:
            what = which + "reports a fault of its own";
            remedy = "Let it cool, switch it off and on.";
            break;
        case FaultKind::too_fast:
            what = which + fmt::format("moved at {:.3g} m/s, and {:g} m/s are allowed", fault.value,
                                       fault.limit);
            remedy =
                "If no hand did that, look at its cables and encoders; otherwise raise settings: "
                "safety: max_speed_m_s.";
            break;
        case FaultKind::turned_too_fast:
            what = which + fmt::format("turned at {:.3g} rad/s, and {:g} rad/s are allowed",
                                       fault.value, fault.limit);
            remedy = "Look at its cables and the encoders of its gimbal.";
            break;
        case FaultKind::late:
            if (fault.value < 0) {
                what = fmt::format("the clock went back by {:.3g} ms", -fault.value * 1e3);
                remedy = "Report it as a bug, with the session's folder.";
                break;
            }
            what = fmt::format("nothing answered the hands for {:.0f} ms, and {:g} ms are allowed",
                               fault.value * 1e3, fault.limit * 1e3);
            remedy = "Close other programs, or look for a device that blocks.";
            break;
        case FaultKind::not_finite:
            what = (fault.device < 0 ? "" : fmt::format("for the {} ", finger)) +
                   "a force was computed that is not a number";
            remedy =
                "Look for an extreme mass, stiffness or damping, or report the session's folder as "
                "a bug.";
            break;
        case FaultKind::keeps_late:
            what = fmt::format(
                "so many ticks came late, {:.0f} ms on average, that not even {:g} N/m could be "
                "rendered calmly",
                fault.value * 1e3, fault.limit);
            remedy = "Close other programs, or lower the rate.";
            break;
        case FaultKind::diverged:
            what = "the simulation diverged: the place or the speed of a body is not a number";
            remedy =
                "Look for an extreme mass, stiffness or damping, or report the session's folder as "
                "a bug.";
            break;
        case FaultKind::active:
            what = (fault.device < 0 ? "" : fmt::format("the {}'s ", finger)) +
                   fmt::format(
                       "coupling went on feeding energy into the hand, {:.2g} J more than "
                       "was put in",
                       fault.value);
            remedy = "Soften the coupling, raise its damping, or give its body more mass.";
            break;
        case FaultKind::chatters:
            what = (fault.device < 0 ? "" : fmt::format("the {}'s ", finger)) +
                   fmt::format("force went on alternating from tick to tick, by {:.1f} N",
                               fault.value);
            remedy = "Soften the coupling, raise its damping, or give its body more mass.";
            break;
        case FaultKind::abandoned:
            what = fmt::format("the window has not answered for {:.1f} s", fault.value);
            remedy = "Close other programs.";
            break;
        case FaultKind::stopped:
            what = "it was stopped by the operator";
            remedy = "What was done until then is recorded.";
            break;
    }
    return fmt::format("force is off since {:.3f} s: {}. {}", seconds(fault.time), what, remedy);
}

}  // namespace dihaptic::haptics
