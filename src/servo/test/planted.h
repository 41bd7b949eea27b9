// A grasp whose devices say what a test plants in them, and tell what they were told.
#pragma once

#include <functional>

#include "lift.h"
#include "rig/rig.h"
#include "servo/servo.h"

namespace dihaptic::servo {

/// Devices of another group. `plant` may change what they read.
class PlantedGroup final : public devices::DeviceGroup {
  public:
    using Plant = std::function<void(std::span<devices::Reading>)>;
    explicit PlantedGroup(std::unique_ptr<devices::DeviceGroup> inner)
        : DeviceGroup(real_infos(*inner)), inner_(std::move(inner)) {}

    Plant plant;
    std::array<Wrench, 2> told{};  ///< what the devices were last told [N]
    bool fails = false;            ///< the next activation is refused

  private:
    void do_activate() override {
        if (fails) throw Error({}, "devices", "are switched off", "Switch them on.");
        inner_->activate();
    }
    void do_deactivate() override { inner_->deactivate(); }
    void do_read(Time now, std::span<devices::Reading> readings) noexcept override {
        inner_->read(now, readings);
        if (plant) plant(readings);
    }
    void do_write(std::span<const Wrench> wrenches_D) noexcept override {
        for (size_t i = 0; i < told.size(); ++i) told[i] = wrenches_D[i];
        inner_->write(wrenches_D);
    }

    std::unique_ptr<devices::DeviceGroup> inner_;
};

/// Two fingers that have closed on a block after 0.3 s, and lift it.
struct PlantedGrasp {
    hand::HandSpec hand = lifting_hand();
    std::unique_ptr<hand::ScriptDriver> driver;
    PlantedGroup* devices = nullptr;
    std::unique_ptr<Servo> servo;
    Time now{0};

    explicit PlantedGrasp(const Settings& settings = {},
                          const std::function<void(std::vector<Pose>&)>& calibrate = {}) {
        const scene::Scene scene = block_on_table();
        const auto fingers = scene::finger_names(scene);
        driver = std::make_unique<hand::ScriptDriver>(hand, fingers);
        const rig::Rig rig = rig::simulated_rig(fingers);
        devices::Context context;
        context.driver = driver.get();
        context.impedance = hand.impedance;
        auto group = std::make_unique<PlantedGroup>(rig::make_devices(rig, fingers, context));
        devices = group.get();
        std::vector<Pose> poses = rig::poses(rig, fingers);
        if (calibrate) calibrate(poses);
        servo = std::make_unique<Servo>(scene, settings, std::move(group), std::move(poses));
        servo->activate();
    }

    const Frame& tick(const Director& director = {}) {
        const Frame& frame = servo->tick(now, director);
        now += servo->period();
        return frame;
    }
    /// Until it has the block.
    void grasp() {
        while (now < std::chrono::milliseconds(400)) tick();
    }
    double told() const {
        return std::max(devices->told[0].force.norm(), devices->told[1].force.norm());
    }
};

}  // namespace dihaptic::servo
