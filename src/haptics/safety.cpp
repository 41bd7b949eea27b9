#include "haptics/safety.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace dihaptic::haptics {
namespace {

/// Whether all values are finite numbers and the orientation is a unit quaternion.
bool is_sound(const frame::Handle& read) noexcept {
    constexpr double kUnit = 1e-3;
    return read.p_WH.allFinite() && read.v_WH.allFinite() && read.w_WH.allFinite() &&
           std::abs(read.R_WH.squaredNorm() - 1) < kUnit;
}

/// Checks a reading of a handle against its state `last`, a time `elapsed` earlier [s]; 0 if there
/// is no earlier reading.
void judge_motion(const frame::Handle& read, const frame::Handle& last, double elapsed,
                  double max_speed, Fault& fault) noexcept {
    double speed = read.v_WH.norm();
    if (elapsed > 0) speed = std::max(speed, (read.p_WH - last.p_WH).norm() / elapsed);
    // written so that infinite and NaN speeds fail too
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

constexpr FaultText kClockWentBack{FaultKind::late, "the clock moved back by {back_ms:.3g} ms",
                                   "report it as a bug, with the session's folder"};

FaultText text_of(const Fault& fault) {
    if (fault.kind == FaultKind::late && fault.value < 0) return kClockWentBack;
    const StatusRow& row = *row_of(fault.kind);
    FaultText text = row.faults[row.faults[0].kind == fault.kind ? 0 : 1];
    if (text.remedy.empty()) text.remedy = row.remedy;
    return text;
}

}  // namespace

frame::Handle HandleGuard::accept(const frame::Handle& read, FaultKind reported, double elapsed,
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
    const FaultText text = text_of(fault);
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
    std::string remedy(text.remedy);
    remedy[0] = static_cast<char>(std::toupper(remedy[0]));
    return fmt::format("force has been off since {:.3f} s: {}. {}.", seconds(fault.time), what,
                       remedy);
}

}  // namespace dihaptic::haptics
