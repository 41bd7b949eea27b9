// Random scenes for tests of energy conservation: spinning boxes and balls that are thrown at a
// table.
#pragma once

#include <cmath>
#include <memory>

#include "base/number.h"
#include "base/random.h"
#include "dynamics/world.h"

namespace dihaptic::dynamics {

class EnergyScene {
  public:
    EnergyScene(uint64_t seed, frame::DynamicsSettings settings) : inertia_{Mat3::Zero()} {
        Random random(seed, "energy");
        scene::Body table;
        table.name = "table";
        table.shape = scene::Shape::box({4, 4, 0.1});
        table.position = {0, 0, -0.05};
        table.fixed = true;
        table.friction = random.uniform(0, 1.5);
        bodies_.push_back(table);
        for (int i = 0; i < 8; ++i) bodies_.push_back(thrown(i, random));
        scene::Scene scene;
        scene.bodies = bodies_;
        settings.sleeping = false;
        world_ = std::make_unique<World>(scene, settings);
        world_->activate();
        for (int i = 1; i < static_cast<int>(bodies_.size()); ++i) {
            const scene::Body& body = bodies_[static_cast<size_t>(i)];
            const scene::VolumeIntegrals unit = scene::integrate(body.shape);
            inertia_.push_back(*body.mass / unit.volume * unit.inertia);
            const Mat3 R = body.pose().R.toRotationMatrix();
            const auto within = [&](double most) { return random.uniform(-most, most); };
            const Vec3 v(within(0.5), within(0.5), random.uniform(-1, 0));
            const Vec3 w(within(10), within(10), within(10));
            world_->set_velocity({i}, v);
            world_->apply({i}, Vec3::Zero(), R * inertia_.back() * R.transpose() * w / kStep);
        }
        world_->step(kStep);
        energy_ = energy();
    }

    /// Does one step, and returns the relative increase in energy, which is negative if the energy
    /// fell. Potential energy is measured from the table top, which no body's centre reaches, so
    /// that the energy is never near zero.
    double step() {
        world_->step(kStep);
        const double before = energy_;
        energy_ = energy();
        return (energy_ - before) / before;
    }

    /// Whether the last step started with an overlap larger than rounding errors.
    bool overlapped() const {
        for (const contact::Contact& contact : world_->contacts()) {
            if (contact.gap < -1e-6) return true;
        }
        return false;
    }

  private:
    static constexpr double kStep = 1e-3;

    static scene::Body thrown(int i, Random& random) {
        const auto within = [&](double most) { return random.uniform(-most, most); };
        const auto length = [&] { return random.uniform(0.02, 0.06); };
        scene::Body body;
        body.name = "body " + number_text(i);
        const Vec3 size(length(), length(), length());
        body.shape = random.uniform(0, 1) < 0.3 ? scene::Shape::sphere(size.x() / 2)
                                                : scene::Shape::box(size);
        body.position = {within(0.05), within(0.05), 0.06 + 0.11 * i};
        body.rotation = {within(3), within(1.5), within(3)};
        body.mass = std::pow(10, random.uniform(-2, 0));
        body.friction = random.uniform(0, 1.5);
        return body;
    }

    double energy() const {
        double sum = 0;
        for (size_t i = 1; i < bodies_.size(); ++i) {
            const BodyState& s = world_->states()[i];
            const Vec3 w_B = s.X_WB.R.conjugate() * s.w_WB;
            const double height = s.X_WB.p.z();
            sum +=
                *bodies_[i].mass * (0.5 * s.v_WB.squaredNorm() - world_->gravity().z() * height) +
                0.5 * w_B.dot(inertia_[i] * w_B);
        }
        return sum;
    }

    std::vector<scene::Body> bodies_;
    std::vector<Mat3> inertia_;
    std::unique_ptr<World> world_;
    double energy_ = 0;
};

}  // namespace dihaptic::dynamics
