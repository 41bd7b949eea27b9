#include "devices/simulated/backend.h"

#include <fmt/format.h>

#include <atomic>
#include <utility>

#include "base/json_schema.h"
#include "devices/simulated/plant.h"

namespace dihaptic::devices::simulated {
namespace {

Options read_options(const DeviceConfig& config, Diagnostics& diagnostics) {
    Options options;
    read_given_fields(options, config.options, diagnostics);
    if (options.peak_torque > 0 && !options.orientation) {
        diagnostics.error(config.place, "peak_torque",
                          "a device that renders torque must measure orientation",
                          "Add orientation: yes, or leave out peak_torque_Nm.");
    }
    if (options.joint_offset != Vec3::Zero() && options.arm != Mechanics::phantom) {
        diagnostics.error(config.place, "joint_offset",
                          "a device without joints has no joint "
                          "offset",
                          "Add arm: phantom, or leave out joint_offset_deg.");
    }
    return options;
}

/// Reads the options of all devices, and checks that the devices can follow the hand.
std::vector<Options> read_options(const std::vector<DeviceConfig>& configs, const Context& context,
                                  Diagnostics& diagnostics) {
    std::vector<Options> options;
    options.reserve(configs.size());
    for (const DeviceConfig& config : configs) options.push_back(read_options(config, diagnostics));
    if (context.driver == nullptr) return options;  // only the rig file is read, without a hand
    for (const Options& option : options) {
        if (Plant::holds(option, context.impedance)) continue;
        diagnostics.error(
            context.impedance.place, "impedance",
            fmt::format(
                "the hand is stiffer or more damped than a simulated device of {:g} g{} can "
                "follow",
                (option.mass + context.impedance.mass) * 1e3,
                option.orientation ? fmt::format(" and {:g} g cm^2", option.inertia * 1e7) : ""),
            "A finger has about 300 N/m and 3 N*s/m, and turns a handle with 1 N*m/rad and 0.02 "
            "N*m*s/rad: check the units.");
        break;
    }
    return options;
}

/// A hand whose fingers appear in the world scaled by s, and which aims accordingly: to reach a
/// target, it moves 1/s of the way from D's origin to the target.
class AimingDriver final : public hand::Driver {
  public:
    AimingDriver(const std::vector<DeviceConfig>& configs, const hand::Driver& seen) : seen_(seen) {
        for (const DeviceConfig& config : configs) aims_.push_back({config.X_WD.p, config.scale});
    }
    double duration() const override { return seen_.duration(); }
    const std::vector<Phase>& phases() const override { return seen_.phases(); }

  private:
    struct Aim {
        Vec3 origin;
        double scale;
    };
    hand::FingerTarget do_target(int finger, double t) const noexcept override {
        hand::FingerTarget target = seen_.target(finger, t);
        const Aim& aim = aims_[static_cast<size_t>(finger)];
        if (aim.scale == 1) return target;
        target.p_WT = aim.origin + (target.p_WT - aim.origin) / aim.scale;
        target.v_WT /= aim.scale;
        return target;
    }

    const hand::Driver& seen_;
    std::vector<Aim> aims_;
};

struct Device {
    Options options;
    Pose X_WD;  // true pose of D: its pose in the rig file, misplaced according to the options
    Plant plant;
    Encoder encoder;
    JointEncoder joints;
    Gimbal gimbal;
    uint32_t clamped = 0;
};

std::vector<frame::DeviceInfo> infos(const std::vector<Options>& options, const Context& context) {
    std::vector<frame::DeviceInfo> out;
    for (const Options& option : options) {
        frame::DeviceInfo info;
        info.model = model_of(option.preset);
        info.serial = option.serial;
        info.simulated = true;
        info.peak_force = option.peak_force;
        if (option.continuous_force) info.continuous_force = *option.continuous_force;
        info.damping = context.impedance.damping;
        info.mass = option.mass + context.impedance.mass;
        info.delay = option.delay_ticks * context.tick;
        info.workspace = option.workspace;
        if (option.arm == Mechanics::phantom) {
            info.arm = option.links;
            info.mass = Arm::least_mass(option) + context.impedance.mass;
        }
        info.max_stiffness = option.max_stiffness;
        info.max_damping = option.max_damping;
        info.measures_orientation = option.orientation;
        info.peak_torque = option.peak_torque;
        if (option.continuous_torque) info.continuous_torque = *option.continuous_torque;
        if (option.orientation) {
            info.turn_damping = context.impedance.turn_damping;
            info.inertia = option.inertia;
        }
        out.push_back(info);
    }
    return out;
}

class SimulatedGroup final : public DeviceGroup {
  public:
    SimulatedGroup(const std::vector<DeviceConfig>& configs, const std::vector<Options>& options,
                   const Context& context)
        : DeviceGroup(infos(options, context)),
          driver_(std::make_unique<AimingDriver>(configs, *context.driver)) {
        for (size_t i = 0; i < configs.size(); ++i) {
            const Pose X_WD = configs[i].X_WD * options[i].misplaced();
            devices_.push_back({options[i], X_WD,
                                Plant(options[i], context.impedance, context.tremor, context.seed,
                                      static_cast<int>(i), *driver_, X_WD),
                                Encoder(options[i]), JointEncoder(options[i]), Gimbal(options[i])});
        }
    }

    bool can_stop() const override { return true; }

  private:
    void do_activate() override {
        begins_ = true;
        stopped_.store(false);
    }
    void do_deactivate() override {}
    void do_read(Time now, std::span<Reading> readings) noexcept override {
        if (std::exchange(begins_, false)) {
            for (Device& device : devices_) device.plant.begin(now);
        }
        for (size_t i = 0; i < devices_.size(); ++i) {
            Device& device = devices_[i];
            if (stopped_.load(std::memory_order_relaxed)) device.plant.release();
            device.plant.advance(now);
            const Pose X_DW = device.X_WD.inverse();
            Encoder::Measured measured;
            Vec3 joints = Vec3::Zero();
            if (const Arm* arm = device.plant.arm()) {
                measured = device.joints.measure(now, *arm);
                joints = arm->reported();
            } else {
                measured = device.encoder.measure(now, X_DW * device.plant.p_WH(),
                                                  X_DW.R * device.plant.v_WH());
            }
            readings[i] = {measured.p, measured.v, static_cast<uint32_t>(device.options.buttons),
                           device.clamped};
            readings[i].joints = joints;
            if (device.options.orientation) {
                const Quat& R_WD = device.X_WD.R;
                const Gimbal::Measured turned =
                    device.gimbal.measure(now, R_WD.conjugate() * device.plant.R_WH() * R_WD,
                                          X_DW.R * device.plant.w_WH());
                readings[i].R_DH = turned.R;
                readings[i].w_DH = turned.w;
            }
            if (const auto& box = device.options.workspace;
                box && (measured.p.array().abs() > box->array() / 2).any()) {
                readings[i].status |= kOutsideWorkspace;
            }
        }
    }
    void do_write(std::span<const Wrench> wrenches_D) noexcept override {
        for (size_t i = 0; i < devices_.size(); ++i) {
            Device& device = devices_[i];
            const Quat& R_WD = device.X_WD.R;
            const bool clamped =
                device.plant.hold({R_WD * wrenches_D[i].force, R_WD * wrenches_D[i].torque});
            device.clamped = clamped ? uint32_t{kForceClamped} : 0;
        }
    }

    bool do_stop() noexcept override {
        stopped_.store(true);
        return true;
    }

    std::unique_ptr<AimingDriver> driver_;
    std::vector<Device> devices_;
    std::atomic<bool> stopped_{false};
    bool begins_ = false;  // whether the plants start at the next reading, whatever its time
};

std::vector<frame::DeviceInfo> describe(const std::vector<DeviceConfig>& configs,
                                        const Context& context, Diagnostics& diagnostics) {
    return infos(read_options(configs, context, diagnostics), context);
}

std::unique_ptr<DeviceGroup> make(const std::vector<DeviceConfig>& configs,
                                  const Context& context) {
    if (context.driver == nullptr) {
        throw Error("simulated devices need a hand that moves them",
                    "Give the scene or the experiment a hand.");
    }
    Diagnostics diagnostics;
    const std::vector<Options> options = read_options(configs, context, diagnostics);
    diagnostics.throw_if_errors();
    return std::make_unique<SimulatedGroup>(configs, options, context);
}

}  // namespace

Backend backend() {
    return {
        .name = "simulated", .describe = describe, .make = make, .options = [](JsonSchema& schema) {
            schema.part_of_kind("options", "simulated", "Options.simulated", Options{});
        }};
}

}  // namespace dihaptic::devices::simulated
