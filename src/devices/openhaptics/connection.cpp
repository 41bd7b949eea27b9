#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "devices/openhaptics/group.h"

namespace dihaptic::devices::openhaptics {
namespace {

bool sound(double limit) {
    return std::isfinite(limit) && limit > 0;
}

}  // namespace

frame::DeviceInfo Options::info() const {
    frame::DeviceInfo out;
    out.serial = serial;
    if (joint_angles) out.arm = links;
    out.max_stiffness = max_stiffness;
    out.max_damping = max_damping;
    return out;
}

Connection::Connection(const Hd& hd, const DeviceConfig& config, const Options& options)
    : hd_(hd),
      options_(options),
      finger_(config.finger),
      place_(config.place),
      info_(options.info()) {
    handle_ = hd.init_device(options.name.empty() ? nullptr : options.name.c_str());
    try {
        check("cannot be reached", "name");
        if (handle_ == kNoHandle) {
            throw Error(place_, "name", who() + " cannot be found",
                        "Switch it on, and check its name in the driver's configuration.");
        }
        read_info();
    } catch (...) {
        if (handle_ != kNoHandle) hd.disable_device(handle_);
        throw;
    }
}

Connection::~Connection() {
    if (handle_ != kNoHandle) hd_.disable_device(handle_);
}

Connection::Connection(Connection&& other) noexcept
    : hd_(std::move(other.hd_)),
      options_(std::move(other.options_)),
      finger_(std::move(other.finger_)),
      place_(std::move(other.place_)),
      handle_(std::exchange(other.handle_, kNoHandle)),
      model_(std::move(other.model_)),
      serial_(std::move(other.serial_)),
      centre_(std::move(other.centre_)),
      info_(std::move(other.info_)) {}

std::string Connection::who() const {
    std::string out = finger_.empty() ? "a device" : fmt::format("the {}'s device", finger_);
    if (!options_.name.empty()) out += fmt::format(" '{}'", options_.name);
    if (!info_.model.empty()) out += fmt::format(" ({})", info_.model);
    return out;
}

void Connection::check(const std::string& doing, const char* key) const {
    const unsigned newest = hd_.get_error().code;
    if (newest == kHdSuccess) return;
    forget_errors();
    const HdErrorText text = describe_error(newest);
    throw Error(place_, key, fmt::format("{} {}: {}", who(), doing, text.what), text.remedy);
}

void Connection::forget_errors() const {
    for (int i = 0; i < kMostErrors && hd_.get_error().code != kHdSuccess; ++i) {
    }
}

double Connection::number(HdValue value) const {
    double out = 0;
    hd_.get_doubles(value, &out);
    return out;
}

std::string Connection::text(HdValue value) const {
    const char* const out = hd_.get_string(value);
    return out == nullptr ? "" : out;
}

void Connection::read_info() {
    hd_.make_current(handle_);
    model_ = text(kHdModel);
    serial_ = text(kHdSerial);
    info_.serial = serial_;
    if (model_.empty()) model_ = "OpenHaptics device";
    info_.model = serial_.empty() ? model_ : fmt::format("{}, serial {}", model_, serial_);
    info_.peak_force = number(kHdMaxForce);
    info_.continuous_force = number(kHdMaxContinuousForce);
    std::array<double, 6> edges{};
    hd_.get_doubles(kHdUsableWorkspace, edges.data());
    const Vec3 least(edges[0], edges[1], edges[2]);
    const Vec3 most(edges[3], edges[4], edges[5]);
    centre_ = (least + most) / 2 * kPerMm;
    info_.workspace = (most - least) * kPerMm;
    if (options_.joint_angles) {
        // HD's own origin is the endpoint position at joint angles of zero; the box is the part of
        // the workspace that is symmetric about that origin
        centre_ = Vec3::Zero();
        info_.workspace = 2 * least.cwiseAbs().cwiseMin(most.cwiseAbs()) * kPerMm;
        check_joints();
    }
    int dof = 0;
    hd_.get_integers(kHdInputDof, &dof);
    info_.measures_orientation = options_.orientation && dof >= 6;
    check("does not report its capabilities", "name");
    read_limits_of_turning();

    if (!sound(info_.peak_force) || !sound(info_.continuous_force) ||
        !sound(info_.workspace->minCoeff()) || !centre_.allFinite()) {
        throw Error(place_, "name",
                    fmt::format("{} states impossible limits: {:g} N peak, {:g} N continuous, "
                                "{:g} x {:g} x {:g} mm",
                                who(), info_.peak_force, info_.continuous_force,
                                info_.workspace->x() / kPerMm, info_.workspace->y() / kPerMm,
                                info_.workspace->z() / kPerMm),
                    "Check its model in the driver's configuration.");
    }
    const double stiffness = number(kHdMaxStiffness) / kPerMm;
    const double damping = number(kHdMaxDamping) / kPerMm;
    forget_errors();  // not every device states these two values
    if (!info_.max_stiffness && sound(stiffness)) info_.max_stiffness = stiffness;
    if (!info_.max_damping && sound(damping)) info_.max_damping = damping;
    if (!options_.serial.empty() && options_.serial != serial_) {
        throw Error(
            place_, "serial",
            fmt::format("{} does not have serial number {}", who(), options_.serial),
            "Correct 'name' or 'serial', or swap the devices in the driver's configuration.");
    }
}

/// Reads the limits on orientation and torque. A device that does not measure orientation or has no
/// known torque limit renders no torque.
void Connection::read_limits_of_turning() {
    int dof = 0;
    hd_.get_integers(kHdOutputDof, &dof);
    const bool turns = info_.measures_orientation && dof >= 6;
    const double peak = turns ? number(kHdMaxTorque) * kPerMm : 0;
    const double continuous = turns ? number(kHdMaxContinuousTorque) * kPerMm : 0;
    forget_errors();  // not every device states these values
    if (!turns && options_.peak_torque) {
        throw Error(place_, "peak_torque", who() + " renders no torque",
                    "Leave it out: torque needs a device with six output degrees of freedom, whose "
                    "orientation is used.");
    }
    if (!turns) return;
    info_.peak_torque = options_.peak_torque.value_or(sound(peak) ? peak : 0);
    if (sound(peak)) info_.peak_torque = std::min(info_.peak_torque, peak);
    if (sound(continuous)) info_.continuous_torque = continuous;
    if (options_.continuous_torque) info_.continuous_torque = *options_.continuous_torque;
}

void Connection::check_joints() const {
    check("does not report its capabilities", "name");
    Vec3 joints = Vec3::Constant(std::nan(""));
    hd_.get_doubles(kHdJointAngles, joints.data());
    forget_errors();
    if (joints.allFinite()) return;
    throw Error(place_, "joint_angles", who() + " does not report its joint angles",
                "Leave out joint_angles.");
}

void Connection::calibrate() const {
    hd_.make_current(handle_);
    int styles = 0;
    hd_.get_integers(kHdCalibrationStyle, &styles);
    const auto has = [&](unsigned style) { return (static_cast<unsigned>(styles) & style) != 0; };
    if (options_.encoder_reset && has(kHdEncoderReset)) hd_.update_calibration(kHdEncoderReset);
    check("cannot be calibrated", "encoder_reset");
    unsigned state = hd_.check_calibration();
    for (const unsigned style : {kHdAuto, kHdInkwell}) {
        if (state != kHdNeedsUpdate || !has(style)) continue;
        hd_.update_calibration(style);
        state = hd_.check_calibration();
    }
    check("cannot be calibrated", "encoder_reset");
    if (state == kHdOk) return;
    std::string remedy = "Calibrate it with the driver's own program.";
    if (has(kHdEncoderReset)) {
        remedy =
            "Hold it in its neutral pose, both links at right angles, and set options: "
            "encoder_reset: yes.";
    } else if (has(kHdInkwell)) {
        remedy = "Put its stylus into the inkwell, and start again.";
    }
    throw Error(place_, "encoder_reset", who() + " needs calibration", remedy);
}

}  // namespace dihaptic::devices::openhaptics
