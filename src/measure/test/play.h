// Simulates play: a hand pushes, pinches, shakes, tosses and presses at random in a cluttered tray
// under a lid. The result is judged by independent mechanics: overlaps are computed from the shapes
// alone, and energy from masses, speeds and the forces on the fingers.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/number.h"
#include "base/random.h"
#include "hand/script.h"
#include "measure/blocks.h"
#include "servo/servo.h"
#include "testing/overlap.h"

namespace dihaptic::measure {

/// A box, ball or capsule, represented as all points within a radius of a box, a point, or a line
/// along z.
struct Rounded {
    Vec3 half = Vec3::Zero();  ///< half extents of the box [m]
    double radius = 0;         ///< [m]

    static Rounded of(const scene::Shape& shape) {
        switch (shape.kind) {
            case scene::ShapeKind::box:
                return {shape.size / 2, 0};
            case scene::ShapeKind::sphere:
                return {Vec3::Zero(), shape.radius};
            default:
                return {Vec3(0, 0, shape.length / 2), shape.radius};
        }
    }
    double reach() const { return half.norm() + radius; }
};

/// Distance of a point from a box; if the point is inside, minus the shortest distance to the
/// surface [m].
inline double box_distance(const Vec3& half, const Vec3& p) {
    const Vec3 beyond = p.cwiseAbs() - half;
    return beyond.cwiseMax(0).norm() + std::min(0.0, beyond.maxCoeff());
}

/// Overlap depth of two shapes; negative if the shapes are apart [m].
inline double overlap(const Rounded& a, const Pose& X_WA, const Rounded& b, const Pose& X_WB) {
    if (a.radius == 0 && b.radius == 0) return box_overlap(a.half, X_WA, b.half, X_WB);
    if (a.radius == 0) return overlap(b, X_WB, a, X_WA);
    // a is a line along its z axis, and the distance from b's core is convex along that line
    const Pose X_BA = X_WB.inverse() * X_WA;
    const auto distance = [&](double z) { return box_distance(b.half, X_BA * Vec3(0, 0, z)); };
    double low = -a.half.z();
    double high = a.half.z();
    for (int i = 0; i < 50 && high - low > 1e-9; ++i) {
        const double third = (high - low) / 3;
        if (distance(low + third) < distance(high - third)) {
            high -= third;
        } else {
            low += third;
        }
    }
    return a.radius + b.radius - distance((low + high) / 2);
}

/// A hand whose script is written while it moves.
class Player final : public hand::Driver {
  public:
    void go_on(std::unique_ptr<hand::ScriptDriver> script, double start) {
        script_ = std::move(script);
        start_ = start;
    }
    double end() const { return start_ + script_->duration(); }
    double duration() const override { return std::numeric_limits<double>::infinity(); }
    const std::vector<Phase>& phases() const override { return script_->phases(); }

  private:
    hand::FingerTarget do_target(int finger, double t) const noexcept override {
        return script_->target(finger, t - start_);
    }
    std::unique_ptr<hand::ScriptDriver> script_;
    double start_ = 0;
};

/// What went wrong during play, and how close the simulation came to going wrong.
struct PlayReport {
    double deepest = 0;  ///< largest overlap of any two bodies [m]
    std::string deepest_pair;
    double deepest_at = 0;        ///< [s]
    double largest_force = 0;     ///< largest force sent [N]
    double largest_change = 0;    ///< largest change of a force between ticks [N]
    double fastest = 0;           ///< largest speed of an object [m/s]
    double hand_work = 0;         ///< upper limit on the work that the fingers did on objects [J]
    double energy_made = 0;       ///< total increase in the objects' energy beyond that limit [J]
    double energy_made_once = 0;  ///< largest increase of this kind in one tick [J]
    uint32_t status = 0;          ///< all status bits that occurred, combined
    int64_t missed = 0;           ///< number of ticks in which the solver missed its tolerance
    int64_t fallbacks = 0;
    int64_t held = 0;    ///< number of ticks in which only the two fingers pressed an object
    int64_t flying = 0;  ///< number of ticks in which an object touched nothing
    int64_t ticks = 0;
    int lost = 0;           ///< number of objects that left the tray at any time
    int64_t generated = 0;  ///< number of ticks in which the energy guard reported something
};

class Play {
  public:
    /// The proxy of the index finger is a ball or a point; that of the thumb is a box.
    Play(const frame::Settings& settings, uint64_t seed,
         scene::ProxyKind index = scene::ProxyKind::rigid)
        : settings_(settings), random_(seed, "play"), has_point_(index == scene::ProxyKind::point) {
        make_scene(index);
        rig::Rig rig = rig::simulated_rig(kFingers);
        devices::Context context;
        context.tick = settings.tick();
        context.driver = &player_;
        context.seed = seed;
        plan(0);
        servo_ = std::make_unique<servo::Servo>(
            scene_, settings, rig::make_devices(rig, kFingers, context), rig::poses(rig, kFingers));
        servo_->activate();
        for (const scene::Body& body : scene_.bodies) shapes_.push_back(Rounded::of(body.shape));
        for (const scene::Finger& finger : scene_.fingers) {
            shapes_.push_back(finger.proxy == scene::ProxyKind::point ? Rounded()
                                                                      : Rounded::of(finger.shape));
        }
        left_.resize(scene_.bodies.size());
    }

    PlayReport run(double time) {
        const double h = settings_.tick();
        PlayReport report;
        const auto ticks = static_cast<int64_t>(std::round(time / h));
        for (int64_t i = 0; i < ticks; ++i) {
            const double now = static_cast<double>(i) * h;
            if (now >= player_.end()) plan(now);
            judge(servo_->tick(i * servo_->period(), {}), report);
        }
        report.lost = static_cast<int>(std::count(left_.begin(), left_.end(), true));
        servo_->deactivate();
        return report;
    }

  private:
    static inline const std::vector<std::string> kFingers{"thumb", "index"};
    static constexpr size_t kFixed = 7;
    static constexpr double kHalfX = 0.16;  // half width of the tray [m]
    static constexpr double kHalfY = 0.12;  // half depth of the tray [m]
    static constexpr double kWall = 0.5;    // height of the tray's walls [m]

    static bool in_tray(const Vec3& p) {
        return std::abs(p.x()) < kHalfX && std::abs(p.y()) < kHalfY && p.z() > 0 && p.z() < kWall;
    }
    double pick(double low, double high) { return random_.uniform(low, high); }

    void make_scene(scene::ProxyKind index_proxy) {
        const auto fixed = [&](const std::string& name, const Vec3& size, const Vec3& p) {
            scene::Body body = box(name, size, p, 0.6);
            body.fixed = true;
            scene_.bodies.push_back(body);
        };
        fixed("floor", {0.6, 0.5, 0.02}, {0, 0, -0.01});
        // some tosses go higher than the walls; with a lid, an object can leave only through one
        fixed("lid", {0.6, 0.5, 0.02}, {0, 0, kWall + 0.01});
        fixed("left wall", {0.01, 0.3, kWall}, {-kHalfX - 0.005, 0, kWall / 2});
        fixed("right wall", {0.01, 0.3, kWall}, {kHalfX + 0.005, 0, kWall / 2});
        fixed("near wall", {0.4, 0.01, kWall}, {0, -kHalfY - 0.005, kWall / 2});
        fixed("far wall", {0.4, 0.01, kWall}, {0, kHalfY + 0.005, kWall / 2});
        fixed("post", {0.02, 0.02, 0.06}, {0.05, 0.03, 0.03});
        for (int i = 0; i < 10; ++i) {
            scene::Body body;
            body.name = "object " + number_text(i);
            const auto size = [&] { return pick(0.015, 0.045); };
            if (i % 3 == 2) {
                body.shape = scene::Shape::sphere(size() / 2);
            } else {
                body.shape = scene::Shape::box({size(), size(), size()});
            }
            // far enough apart for any orientation: the largest object reaches 39 mm
            body.position = {-0.11 + 0.055 * (i % 5), i < 5 ? -0.06 : 0.07, 0.11 + 0.08 * (i % 2)};
            body.rotation = {pick(-1, 1), pick(-1, 1), pick(-3, 3)};
            body.mass = std::pow(10, pick(-2, -0.7));  // 10 to 200 g
            body.friction = pick(0.2, 1);
            scene_.bodies.push_back(body);
        }
        scene::Finger thumb;
        thumb.name = "thumb";
        thumb.shape = scene::Shape::box({0.01, 0.01, 0.02});
        scene::Finger index;
        index.name = "index";
        index.shape = scene::Shape::sphere(0.008);
        index.torsion_radius = 0.004;
        index.proxy = index_proxy;
        scene_.fingers = {thumb, index};
        for (size_t b = 0; b < scene_.bodies.size(); ++b) {
            const scene::Body& body = scene_.bodies[b];
            const scene::VolumeIntegrals unit = scene::integrate(body.shape);
            inertia_.push_back(b < kFixed ? Mat3::Zero()
                                          : Mat3(*body.mass / unit.volume * unit.inertia));
        }
    }

    /// Plans the next action of the hand, starting from its current position.
    void plan(double now) {
        hand::HandSpec spec;
        spec.centre = centre_;
        spec.aperture = aperture_;
        const Vec3 side(std::cos(yaw_), std::sin(yaw_), 0);
        spec.fingers = {{"thumb", -side, Vec3::Zero()}, {"index", side, Vec3::Zero()}};
        const auto step = [&](const Vec3& to, double duration, double aperture, double turn = 0,
                              const Vec3& end_velocity = Vec3::Zero()) {
            hand::ScriptStep& s = spec.script.emplace_back();
            // fingers push against walls and floor about as hard as the devices can render
            const Vec3 most(kHalfX - 0.025, kHalfY - 0.025, 0.4);
            const Vec3 least(-most.x(), -most.y(), -0.02);
            const Vec3 goal = to.cwiseMin(most).cwiseMax(least);
            s.name = "step";
            s.duration = duration;
            s.aperture = aperture;
            s.move = goal - centre_;
            s.turn = {0, 0, turn};
            s.end_velocity = end_velocity;
            centre_ = goal;
            aperture_ = aperture;
            yaw_ += turn;
        };
        const Vec3 object = some_object();
        const double kind = pick(0, 1);
        if (kind < 0.5) {
            step({object.x(), object.y(), 0.1}, pick(0.2, 0.5), 0.09, pick(-1.5, 1.5));
            step({object.x(), object.y(), std::max(0.012, object.z())}, pick(0.15, 0.4), 0.09);
            step(centre_, pick(0.1, 0.4), pick(0, 0.03));
            step(centre_ + Vec3(pick(-0.05, 0.05), pick(-0.05, 0.05), pick(0.05, 0.15)),
                 pick(0.2, 0.5), aperture_);
            const double then = pick(0, 1);
            if (then < 0.6) {  // toss
                const Vec3 v(pick(-0.5, 0.5), pick(-0.5, 0.5), pick(0.2, 1.6));
                step(centre_ + 0.1 * v, 0.2, aperture_, 0, v);
                step(centre_ + 0.05 * v, 0.12, 0.09);
            } else if (then < 0.8) {  // swing the object and let it drop
                step(centre_, pick(0.2, 0.6), aperture_, pick(-1.5, 1.5));
                step(centre_, pick(0.05, 0.3), 0.09);
            } else {  // slam
                step({centre_.x(), centre_.y(), 0}, pick(0.08, 0.3), aperture_);
                step(centre_, 0.1, 0.06);
            }
        } else if (kind < 0.75) {  // push sideways into other objects and the walls
            const double angle = pick(-3.1, 3.1);
            const Vec3 way(std::cos(angle), std::sin(angle), 0);
            step({centre_.x(), centre_.y(), 0.08}, 0.15, 0.03);
            step(object - 0.06 * way, pick(0.2, 0.5), 0.03, pick(-1, 1));
            step(object + pick(0.03, 0.15) * way, pick(0.1, 0.5), 0.03);
        } else if (kind < 0.9) {  // press from above
            step({object.x(), object.y(), 0.1}, pick(0.2, 0.5), pick(0, 0.03));
            step({object.x(), object.y(), pick(-0.02, 0.03)}, pick(0.1, 0.5), aperture_);
            step(centre_ + Vec3(pick(-0.03, 0.03), pick(-0.03, 0.03), 0), 0.3, aperture_);
        } else {  // move anywhere, through everything
            for (int i = 0; i < 3; ++i) {
                step({pick(-kHalfX, kHalfX), pick(-kHalfY, kHalfY), pick(0, 0.15)}, pick(0.15, 0.5),
                     pick(0, 0.09), pick(-1, 1));
            }
        }
        player_.go_on(std::make_unique<hand::ScriptDriver>(spec, kFingers), now);
    }

    /// Returns the position of an object within reach.
    Vec3 some_object() {
        for (int i = 0; servo_ && i < 20; ++i) {
            const auto which =
                static_cast<size_t>(pick(kFixed, static_cast<double>(scene_.bodies.size()) - 1e-9));
            const Vec3& p = servo_->world().states()[which].X_WB.p;
            if (in_tray(p) && p.z() < 0.2) return p;
        }
        return {0, 0, 0.02};
    }

    double energy() const {
        double sum = 0;
        for (size_t b = kFixed; b < scene_.bodies.size(); ++b) {
            const dynamics::BodyState& s = servo_->world().states()[b];
            const Vec3 w_B = s.X_WB.R.conjugate() * s.w_WB;
            sum += *scene_.bodies[b].mass *
                       (s.v_WB.squaredNorm() / 2 - scene_.gravity.z() * s.X_WB.p.z()) +
                   w_B.dot(inertia_[b] * w_B) / 2;
        }
        return sum;
    }

    void judge(const frame::Frame& frame, PlayReport& out) {
        const double h = settings_.tick();
        const double now = seconds(frame.time);
        out.status |= frame.status;
        out.missed += (frame.status & kSolverMissed) != 0;
        out.fallbacks += frame.solver_fallback;
        out.generated += (frame.status & kEnergyGenerated) != 0;
        ++out.ticks;
        const size_t bodies = frame.bodies.size();
        last_force_.resize(frame.fingers.size(), Vec3::Zero());
        std::vector<Pose> X_WB;
        for (const frame::BodyFrame& body : frame.bodies) {
            X_WB.push_back(body.X_WB);
            out.fastest = std::max(out.fastest, body.v_WB.norm());
        }
        for (size_t b = kFixed; b < bodies; ++b) left_[b] = left_[b] || !in_tray(X_WB[b].p);
        for (size_t f = 0; f < frame.fingers.size(); ++f) {
            const frame::FingerFrame& finger = frame.fingers[f];
            X_WB.push_back({finger.R_WP, finger.p_WP});
            out.largest_force = std::max(out.largest_force, finger.f_sent_W.norm());
            out.largest_change =
                std::max(out.largest_change, (finger.f_sent_W - last_force_[f]).norm());
            last_force_[f] = finger.f_sent_W;
        }
        for (size_t a = 0; a < X_WB.size(); ++a) {
            for (size_t b = std::max(a + 1, kFixed); b < X_WB.size(); ++b) {
                // a point proxy touches bodies of the scene, but not other fingers
                if (a >= bodies && has_point_) continue;
                if ((X_WB[a].p - X_WB[b].p).norm() > shapes_[a].reach() + shapes_[b].reach())
                    continue;
                const double deep = overlap(shapes_[a], X_WB[a], shapes_[b], X_WB[b]);
                if (deep <= out.deepest) continue;
                out.deepest = deep;
                out.deepest_at = now;
                const auto name = [&](size_t i) {
                    return i < bodies ? scene_.bodies[i].name : kFingers[i - bodies];
                };
                out.deepest_pair = name(a) + " and " + name(b);
            }
        }
        // if J is the impulse of a step on an object, and the finger has velocity v at the contact,
        // objects gain at most J . v, since the contact law holds at the end of a step
        double work = 0;
        std::vector<char> touched(bodies, 0);
        std::vector<int> fingers_on(bodies, 0);
        for (const frame::ContactFrame& contact : frame.contacts) {
            if (contact.normal_force <= 0) continue;
            const auto a = static_cast<size_t>(contact.a);
            const auto b = static_cast<size_t>(contact.b);
            if (a < bodies && b >= bodies) {
                ++fingers_on[a];
                if (a >= kFixed) work -= h * contact.f_B_W.dot(frame.fingers[b - bodies].v_WP);
            } else {
                if (a < bodies) touched[a] = 1;
                if (b < bodies) touched[b] = 1;
            }
        }
        for (size_t b = kFixed; b < bodies; ++b) {
            out.held += fingers_on[b] == 2 && !touched[b];
            out.flying += fingers_on[b] == 0 && !touched[b] && frame.bodies[b].awake;
        }
        const double now_energy = energy();
        if (energy_) {
            const double made = now_energy - *energy_ - work;
            out.energy_made += std::max(0.0, made);
            out.energy_made_once = std::max(out.energy_made_once, made);
            out.hand_work += std::max(0.0, work);
        }
        energy_ = now_energy;
    }

    frame::Settings settings_;
    Random random_;
    bool has_point_;
    scene::Scene scene_;
    std::vector<Rounded> shapes_;  // shapes of the bodies, followed by those of the fingers
    std::vector<Mat3> inertia_;    // one per body, in B
    std::vector<bool> left_;       // for each body, whether it left the tray
    Vec3 centre_{0, 0, 0.15};
    double aperture_ = 0.09;
    double yaw_ = 0;
    Player player_;
    std::unique_ptr<servo::Servo> servo_;
    std::vector<Vec3> last_force_;
    std::optional<double> energy_;
};

/// Plays for `time` [s] with the energy guard armed, and expects that nothing goes wrong and that
/// the guard reports nothing.
inline PlayReport expect_harmless_play(contact::Solver solver, uint64_t seed, double time,
                                       scene::ProxyKind index = scene::ProxyKind::rigid) {
    frame::Settings settings;
    settings.dynamics.solver = solver;
    settings.safety.energy_guard = frame::EnergyGuardMode::act;
    Play play(settings, seed, index);
    const PlayReport report = play.run(time);
    std::printf(
        "deepest overlap %.3f mm (%s, at %.3f s); force %.2f N, change %.2f N; fastest object %.1f "
        "m/s; fingers' work %.2f J, energy made %.1e J; held %.0f s, flying %.0f s; solves missed "
        "%ld, by another %ld, of %ld; guard spoke in %ld\n",
        report.deepest * 1e3, report.deepest_pair.c_str(), report.deepest_at, report.largest_force,
        report.largest_change, report.fastest, report.hand_work, report.energy_made,
        static_cast<double>(report.held) * settings.tick(),
        static_cast<double>(report.flying) * settings.tick(), static_cast<long>(report.missed),
        static_cast<long>(report.fallbacks), static_cast<long>(report.ticks),
        static_cast<long>(report.generated));
    EXPECT_EQ(
        report.status & (kNotFinite | kForceOff | kContactsFull | kEnergyGenerated | kEnergyDamped),
        0u);
    EXPECT_LE(report.largest_force, 8.5 + 1e-9);
    EXPECT_LE(report.largest_change, settings.safety.max_force_rate * settings.tick() + 1e-9);
    EXPECT_LE(report.deepest, 1e-3) << report.deepest_pair << " at " << report.deepest_at << " s";
    EXPECT_LE(report.energy_made, 1e-3 * report.hand_work);
    EXPECT_EQ(report.lost, 0);
    EXPECT_GT(report.flying, 0);
    return report;
}

}  // namespace dihaptic::measure
