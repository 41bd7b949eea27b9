// A grasp with devices whose readings a test can replace (planted_group.h).
#pragma once

#include <functional>

#include "lift.h"
#include "planted_group.h"
#include "rig/rig.h"
#include "servo/servo.h"

namespace dihaptic::servo {

/// Two fingers that close on a block within 0.3 s and lift it.
struct PlantedGrasp {
    hand::HandSpec hand = lifting_hand();
    std::unique_ptr<hand::ScriptDriver> driver;
    PlantedGroup* devices = nullptr;
    std::unique_ptr<Servo> servo;
    Time now{0};

    explicit PlantedGrasp(const frame::Settings& settings = {},
                          const std::function<void(std::vector<Pose>&)>& calibrate = {}) {
        const scene::Scene scene = block_on_table();
        const auto fingers = scene::finger_names(scene);
        driver = std::make_unique<hand::ScriptDriver>(hand, fingers);
        const rig::Rig rig = rig::simulated_rig(fingers);
        devices::Context context;
        context.driver = driver.get();
        context.impedance = hand.impedance;
        auto group =
            std::make_unique<PlantedGroup>(rig::make_devices(rig, fingers, context), false);
        devices = group.get();
        std::vector<Pose> poses = rig::poses(rig, fingers);
        if (calibrate) calibrate(poses);
        servo = std::make_unique<Servo>(scene, settings, std::move(group), std::move(poses));
        servo->activate();
    }

    const frame::Frame& tick(const frame::Director& director = {}) {
        const frame::Frame& frame = servo->tick(now, director);
        now += servo->period();
        return frame;
    }
    /// Runs ticks until the fingers hold the block.
    void grasp() {
        while (now < std::chrono::milliseconds(400)) tick();
    }
    double told() const { return devices->largest_told(); }
};

}  // namespace dihaptic::servo
