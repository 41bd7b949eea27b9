#include "bench/friction.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "base/number.h"
#include "measure/blocks.h"
#include "model/grasp.h"
#include "model/gravity.h"

namespace dihaptic::bench {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
using model::kGravity;
constexpr double kFallen = 0.02;  // a body that moved this far has fallen [m]
constexpr double kParts = 9;      // number of parts of the bench, for its progress

scene::Body box_at(const std::string& name, const Vec3& size, const Pose& X_WB, double friction) {
    scene::Body body = measure::box(name, size, X_WB.p, friction);
    // body.rotation is about the fixed axes x, y, z: read it back from the matrix Rz Ry Rx
    const Mat3 R = X_WB.R.toRotationMatrix();
    body.rotation = {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
                     std::atan2(R(1, 0), R(0, 0))};
    return body;
}

int steps(double time) {
    return static_cast<int>(std::lround(time / kStep));
}

/// Largest displacement of any body's centre of volume after some time [m].
struct Drift {
    double drawn = 0;    ///< from the drawn pose
    double settled = 0;  ///< from its pose after a second, when soft contacts bear their load
};
/// Stops when a body moves farther than `fallen`; `drawn` is then a displacement beyond it.
Drift drift(const scene::Scene& scene, const Simulator& simulator, double time,
            double fallen = std::numeric_limits<double>::infinity()) {
    const int settling = steps(1);
    std::vector<Vec3> centre;
    std::vector<Vec3> drawn;
    for (const scene::Body& body : scene.bodies) {
        centre.push_back(scene::integrate(body.shape).centre);
        drawn.push_back(body.pose() * centre.back());
    }
    std::vector<Vec3> settled = drawn;
    Drift out;
    int step = 0;
    simulator.run({scene, {}}, steps(time), [&](std::span<const Pose> X_WB) {
        ++step;
        out = {};
        for (size_t i = 0; i < centre.size(); ++i) {
            const Vec3 p = X_WB[i] * centre[i];
            if (step <= settling) settled[i] = p;
            out.drawn = std::max(out.drawn, (p - drawn[i]).norm());
            out.settled = std::max(out.settled, (p - settled[i]).norm());
        }
        return out.drawn <= fallen;
    });
    return out;
}

std::optional<double> standing(double drift) {
    return drift < kFallen ? std::optional(drift * 1e3) : std::nullopt;
}

/// Storeys of the highest house of cards, from 2 to 6, that stands for 3 s; 0 if none.
int storeys_held(const Simulator& simulator, const std::function<void(int)>& say) {
    for (int storeys = 6; storeys >= 2; --storeys) {
        say(storeys);
        if (drift(cards_scene(storeys), simulator, 3, kFallen).drawn < kFallen) return storeys;
    }
    return 0;
}

/// Sliding of a block from rest: its acceleration down the slope, and its angle from the fall line,
/// over the last 0.8 s of one second. Soft contacts need the first 0.2 s to settle.
struct Slide {
    double acceleration = 0;
    double off_fall_line = 0;
};
Slide slide(double slope, double turn, const Simulator& simulator) {
    const Trial trial{incline_scene(slope, turn, 0.5, simulator.slope), {}};
    std::array<Vec3, 3> p_WB;
    const int apart = steps(0.4);
    int step = 0;
    simulator.run(trial, steps(1), [&](std::span<const Pose> X_WB) {
        ++step;
        if (step % apart == steps(0.2)) p_WB[static_cast<size_t>(step / apart)] = X_WB[1].p;
        return true;
    });
    const Vec3 way = p_WB[2] - p_WB[0];
    const Vec3 gained = p_WB[2] - 2 * p_WB[1] + p_WB[0];
    const Vec3 fall =
        Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ())) * Vec3(std::cos(slope), 0, -std::sin(slope));
    const double time = apart * kStep;
    return {gained.dot(fall) / (time * time), std::atan2(way.cross(fall).norm(), way.dot(fall))};
}

/// Largest slip of a pad, in the block's frame, in the minute after the first second [m].
double pinch_slip(const Simulator& simulator) {
    const int settled = steps(1);
    const auto pad_on_block = [](std::span<const Pose> X_WB, size_t pad) {
        return X_WB[0].inverse() * X_WB[pad].p;
    };
    std::array<Vec3, 2> start;
    double most = 0;
    int step = 0;
    simulator.run(pinch_trial(), settled + steps(60), [&](std::span<const Pose> X_WB) {
        ++step;
        for (size_t i = 0; i < start.size(); ++i) {
            const Vec3 p_BP = pad_on_block(X_WB, i + 1);
            if (step <= settled) start[i] = p_BP;
            most = std::max(most, (p_BP - start[i]).norm());
            if (!p_BP.allFinite() || X_WB[0].p.norm() > 1)
                most = std::numeric_limits<double>::infinity();
        }
        return most <= kFallen;
    });
    return most;
}

}  // namespace

scene::Scene incline_scene(double slope, double turn, double friction, scene::ShapeKind kind) {
    // the fall line is turned about the vertical, while the block's edges keep the world's
    // directions, so that there is no alignment
    const Quat R_table(Eigen::AngleAxisd(turn, Vec3::UnitZ()) *
                       Eigen::AngleAxisd(slope, Vec3::UnitY()));
    const Quat R_block(R_table * Quat(Eigen::AngleAxisd(-turn, Vec3::UnitZ())));
    scene::Scene scene;
    const bool is_box = kind == scene::ShapeKind::box;
    scene::Body ground = box_at("slope", {20, 20, 0.1},
                                {R_table, R_table * Vec3(0, 0, is_box ? -0.05 : 0)}, friction);
    ground.shape.kind = kind;
    ground.fixed = true;
    scene::Body block = box_at("block", Vec3::Constant(measure::kBlockSize),
                               {R_block, R_table * Vec3(0, 0, measure::kBlockSize / 2)}, friction);
    block.mass = 0.1;
    scene.bodies = {ground, block};
    return scene;
}

scene::Scene stack_scene(int blocks) {
    scene::Scene scene;
    scene.bodies = {measure::table(1, 0.8)};
    for (int i = 0; i < blocks; ++i) {
        scene::Body block =
            measure::box("block " + number_text(i), Vec3::Constant(measure::kBlockSize),
                         {0, 0, (i + 0.5) * measure::kBlockSize}, 0.8);
        block.mass = 0.1;
        scene.bodies.push_back(block);
    }
    return scene;
}

scene::Scene cards_scene(int storeys) {
    const double length = 0.08, width = 0.05, thick = 0.002, friction = 0.7;
    const double lean = 20 * kDegree;
    // a card's half extents along and across, and the corners of its cross-section that touch: the
    // inner top corners of a pair meet in the middle, the lowest corner stands on z = 0
    const double u = length / 2, n = thick / 2;
    const double centre_x = u * std::sin(lean) + n * std::cos(lean);
    const double centre_z = u * std::cos(lean) + n * std::sin(lean);
    const double height = 2 * centre_z;  // height of a pair's highest corners
    // neighbouring pairs do not touch each other
    const double outermost = centre_x + u * std::sin(lean) + n * std::cos(lean);
    const double pitch = 2 * outermost + thick;
    scene::Scene scene;
    scene.bodies = {measure::table(1, friction)};
    // decks side by side must not overlap
    const double deck = storeys > 2 ? std::min(length, pitch - thick / 4) : length;
    const auto card = [&](const Vec3& position, double angle, double size) {
        scene::Body body =
            box_at("card " + number_text(scene.bodies.size()), {thick, width, size},
                   {Quat(Eigen::AngleAxisd(angle, Vec3::UnitY())), position}, friction);
        body.mass = 0.008;
        scene.bodies.push_back(body);
    };
    for (int storey = 0; storey < storeys; ++storey) {
        const double z = storey * (height + thick);
        const int pairs = storeys - storey;
        for (int i = 0; i < pairs; ++i) {
            const double x = (i - 0.5 * (pairs - 1)) * pitch;
            card({x - centre_x, 0, z + centre_z}, lean, length);
            card({x + centre_x, 0, z + centre_z}, -lean, length);
        }
        for (int i = 0; i + 1 < pairs; ++i) {
            card({(i - 0.5 * (pairs - 2)) * pitch, 0, z + height + thick / 2}, std::numbers::pi / 2,
                 deck);
        }
    }
    return scene;
}

scene::Scene arch_scene(int voussoirs) {
    const double inner = 0.08, outer = 0.12, depth = 0.04, friction = 0.7;
    scene::Scene scene;
    scene.bodies = {measure::table(1, friction)};
    for (int i = 0; i < voussoirs; ++i) {
        scene::Body stone;
        stone.name = "voussoir " + number_text(i);
        stone.shape.kind = scene::ShapeKind::mesh;
        std::vector<Vec3> points;
        for (const double angle :
             {std::numbers::pi * i / voussoirs, std::numbers::pi * (i + 1) / voussoirs}) {
            for (const double radius : {inner, outer}) {
                for (const double y : {-depth / 2, depth / 2}) {
                    points.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
                }
            }
        }
        stone.shape.hull = scene::convex_hull(points);
        stone.density = 2000;
        stone.friction = friction;
        scene.bodies.push_back(stone);
    }
    return scene;
}

Trial pinch_trial() {
    Trial trial;
    const double grip = measure::press_force({});
    scene::Body block =
        measure::box("block", Vec3::Constant(measure::kBlockSize), Vec3::Zero(), 0.8);
    block.mass = 0.1;
    trial.scene.bodies = {block};
    for (const double side : {-1.0, 1.0}) {
        const double x = side * (measure::kBlockSize + measure::kPadThickness) / 2;
        scene::Body pad = measure::box(side < 0 ? "left" : "right",
                                       {measure::kPadThickness, 0.020, 0.020}, {x, 0, 0}, 0.8);
        pad.mass = 0.075;
        pad.moves = scene::Axes::x;
        pad.turns = scene::Axes::none;
        trial.pushes.push_back({trial.scene.bodies.size(), {-side * grip, 0, 0}});
        trial.scene.bodies.push_back(pad);
    }
    return trial;
}

FrictionFigures bench_slides_and_piles(const Simulator& simulator,
                                       const measure::Progress& progress) {
    FrictionFigures out;
    out.solver = simulator.name;
    double done = 0;
    const auto say = [&](const std::string& what) {
        if (progress) progress(what, done++ / kParts);
    };
    say("incline, held");
    out.drift_mm =
        drift(incline_scene(26 * kDegree, 0, 0.5, simulator.slope), simulator, 5).drawn * 1e3;
    say("incline, released");
    const double slope = 27 * kDegree;
    out.accel_error = slide(slope, 0, simulator).acceleration /
                          (kGravity * (std::sin(slope) - 0.5 * std::cos(slope))) -
                      1;
    say("incline, turned");
    for (int i = 0; i <= 12; ++i) {
        out.direction_error_deg =
            std::max(out.direction_error_deg,
                     slide(30 * kDegree, i * 7.5 * kDegree, simulator).off_fall_line / kDegree);
    }
    say("stack");
    const Drift stack = drift(stack_scene(10), simulator, 10);
    out.stack_drift_mm = stack.drawn * 1e3;
    out.stack_settled_mm = stack.settled * 1e3;
    const auto stood = [&](const scene::Scene& scene, std::optional<double>& drift_mm,
                           std::optional<double>& settled_mm) {
        const Drift moved = drift(scene, simulator, 10, kFallen);
        drift_mm = standing(moved.drawn);
        if (drift_mm) settled_mm = standing(moved.settled);
    };
    say("house of cards");
    stood(cards_scene(2), out.cards_drift_mm, out.cards_settled_mm);
    say("arch");
    stood(arch_scene(9), out.arch_drift_mm, out.arch_settled_mm);
    return out;
}

FrictionFigures bench_peer_friction(const Simulator& simulator, const measure::Progress& progress) {
    FrictionFigures out = bench_slides_and_piles(simulator, progress);
    out.cards_storeys = storeys_held(simulator, [&](int storeys) {
        if (progress) progress(fmt::format("house of {} storeys", storeys), 6 / kParts);
    });
    if (progress) progress("pinched block", 7 / kParts);
    out.pinch_mm = standing(pinch_slip(simulator));
    return out;
}

double measure_creep(const frame::DynamicsSettings& settings) {
    measure::BenchSetup setup;
    setup.settings.dynamics = settings;
    setup.settings.coupling.stiffness = 1000;
    setup.hold_time = 60;
    return measure::measure_hold(setup).slip_mm;
}

FrictionFigures bench_friction(const frame::DynamicsSettings& settings,
                               const measure::Progress& progress) {
    FrictionFigures out = bench_peer_friction(world_simulator(settings), progress);
    if (progress) progress("creep of a held block", 8 / kParts);
    out.creep_mm = measure_creep(settings);
    return out;
}

}  // namespace dihaptic::bench
