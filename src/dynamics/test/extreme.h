// Scenes that are as hard for the solvers as scene files permit, for tests and soak tests: fingers
// press on bodies of any size and mass, which are stacked, joined, on rails, or deep inside each
// other.
#pragma once

#include "base/number.h"
#include "base/random.h"
#include "dynamics/test/blocks.h"

namespace dihaptic::dynamics {

/// A world with an extreme scene, and two fingers that press from both sides.
class Extreme {
  public:
    explicit Extreme(uint64_t seed, const frame::DynamicsSettings& settings = awake())
        : random_(seed, "extreme scenes"), world_(scene(), settings) {
        for (const double side : {-1.0, 1.0}) {
            scene::Finger finger;
            finger.name = side < 0 ? "left" : "right";
            finger.shape = scene::Shape::box({0.005, 0.02, 0.02});
            finger.mass = std::pow(10, random_.uniform(-3, 0));
            fingers_.push_back(world_.add_proxy(finger, {side * (reach_ + 0.0026), 0, height_}));
        }
        world_.activate();
    }

    World& world() { return world_; }

    /// Does one step, in which the fingers squeeze and shake as a function of the tick number.
    StepStatus step(int tick) {
        for (const BodyIndex finger : fingers_) {
            const double side = finger.value == fingers_[0].value ? 1 : -1;
            const double shake = std::sin(0.3 * tick + finger.value);
            world_.apply(finger, {5 * side, shake, 2 * shake}, Vec3::Zero());
        }
        return world_.step(kStep);
    }
    /// Whether a finger touches any body.
    bool touched() const {
        for (const contact::Contact& contact : world_.contacts()) {
            for (const BodyIndex finger : fingers_) {
                if (contact.a.value == finger.value || contact.b.value == finger.value) return true;
            }
        }
        return false;
    }

  private:
    double power(double low, double high) { return std::pow(10, random_.uniform(low, high)); }
    bool chance(double share) { return random_.uniform(0, 1) < share; }
    Vec3 vector(double size) {
        return {random_.uniform(-size, size), random_.uniform(-size, size),
                random_.uniform(-size, size)};
    }

    /// Creates the scene. The first body lies between the fingers; other bodies are stacked on it
    /// or scattered through it.
    scene::Scene scene() {
        scene::Scene out;
        out.bodies.push_back(table());
        const int count = 1 + static_cast<int>(power(0, 1.6));
        const double size = power(-2, -0.7);
        const bool stacked = chance(0.5);
        const double overlap = chance(0.5) ? random_.uniform(0, 1) : 0;  // relative to the size
        const double masses = random_.uniform(0, 3);  // range in orders of magnitude
        reach_ = size / 2;
        height_ = (0.5 - overlap * random_.uniform(0, 1)) * size;
        for (int i = 0; i < count; ++i) {
            Vec3 position(0, 0, height_ + i * (1 - overlap) * size);
            if (!stacked && i > 0) position = Vec3(0, 0, height_) + vector((2 - overlap) * size);
            const Vec3 sizes = Vec3::Constant(size) + vector(i > 0 ? 0.5 * size : 0);
            scene::Body body = box("body " + number_text(i), sizes, position,
                                   power(-1 - masses / 2, -1 + masses / 2), power(-1, 0.3));
            make_extreme(body, i);
            out.bodies.push_back(body);
        }
        for (int i = 1; i < count; ++i) {
            if (chance(0.15)) out.joints.push_back(joint_of(out, i));
        }
        return out;
    }
    void make_extreme(scene::Body& body, int i) {
        if (chance(0.1)) body.shape = scene::Shape::box({power(-2, 2), 0.04, power(-3, -1)});
        if (chance(0.2)) {
            body.moves = chance(0.5) ? scene::Axes::x : scene::Axes::xz;
            body.turns = scene::Axes::none;
        } else if (i > 0 && chance(0.5)) {
            body.rotation = vector(0.5);
        }
    }
    scene::Joint joint_of(const scene::Scene& scene, int i) {
        const int other = static_cast<int>(random_.uniform(0, i));
        const auto name = [](int body) { return "body " + number_text(body); };
        scene::Joint out =
            joint(static_cast<scene::JointKind>(random_.uniform(0, 6)), {name(i), name(other)},
                  scene.bodies[static_cast<size_t>(i) + 1].position);
        out.name = "joint " + number_text(i);
        out.axis = vector(1).normalized();
        out.second_axis = out.axis.unitOrthogonal();
        if (out.is_distance()) {
            out.second_position =
                scene.bodies[static_cast<size_t>(other) + 1].position + Vec3(0, 0, 0.01);
            out.rest = power(-3, -1);
        }
        if (out.has_coordinate() && chance(0.5)) {
            out.stiffness = power(0, 5);
            out.damping = power(-2, 1);
        }
        return out;
    }

    Random random_;
    double reach_ = 0;
    double height_ = 0;
    World world_;
    std::vector<BodyIndex> fingers_;
};

}  // namespace dihaptic::dynamics
