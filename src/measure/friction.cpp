#include "measure/friction.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "measure/blocks.h"

namespace dihaptic::measure {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kGravity = 9.81;
constexpr double kStep = 1e-3;    // [s]
constexpr double kFallen = 0.02;  // a card or a stone that moved so far has fallen [m]

scene::Body box_at(const std::string& name, const Vec3& size, const Pose& X_WB, double friction) {
    scene::Body body = box(name, size, X_WB.p, friction);
    // body.rotation is about the fixed axes x, y, z: read it back from the matrix Rz Ry Rx
    const Mat3 R = X_WB.R.toRotationMatrix();
    body.rotation = {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
                     std::atan2(R(1, 0), R(0, 0))};
    return body;
}

dynamics::World make_world(const scene::Scene& scene, dynamics::Settings settings) {
    settings.sleeping = false;
    dynamics::World world(scene, settings);
    world.activate();
    return world;
}

/// Largest displacement of any movable body's centre of volume after some time [m]; of what has
/// fallen before, some displacement beyond `fallen`.
double drift(const scene::Scene& scene, const dynamics::Settings& settings, double time,
             double fallen = std::numeric_limits<double>::infinity()) {
    dynamics::World world = make_world(scene, settings);
    std::vector<Vec3> centre;
    std::vector<Vec3> start;
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        centre.push_back(scene::integrate(scene.bodies[i].shape).centre);
        start.push_back(world.states()[i].X_WB * centre[i]);
    }
    const auto displacement = [&] {
        double most = 0;
        for (size_t i = 0; i < scene.bodies.size(); ++i) {
            most = std::max(most, (world.states()[i].X_WB * centre[i] - start[i]).norm());
        }
        return most;
    };
    const auto steps = static_cast<int>(std::lround(time / kStep));
    for (int i = 0; i < steps; ++i) {
        world.step(kStep);
        if (i % 50 == 0 && displacement() > fallen) break;
    }
    return displacement();
}

std::optional<double> standing(double drift) {
    return drift < kFallen ? std::optional(drift * 1e3) : std::nullopt;
}

/// Storeys of the highest house of cards, of 2 to 6, that stands for 3 s.
int storeys_held(const dynamics::Settings& settings, const std::function<void(int)>& say) {
    for (int storeys = 6; storeys >= 2; --storeys) {
        say(storeys);
        if (drift(cards_scene(storeys), settings, 3, kFallen) < kFallen) return storeys;
    }
    return 0;
}

/// Slides for a second on a slope from rest; displacement along the slope, and angle off the fall
/// line.
struct Slide {
    double acceleration = 0;
    double off_fall_line = 0;
};
Slide slide(double slope, double turn, const dynamics::Settings& settings) {
    const scene::Scene scene = incline_scene(slope, turn, 0.5);
    dynamics::World world = make_world(scene, settings);
    const Vec3 start = world.states()[1].X_WB.p;
    const int steps = 1000;
    for (int i = 0; i < steps; ++i) world.step(kStep);
    const Vec3 way = world.states()[1].X_WB.p - start;
    // semi-implicit Euler from rest: x_n = a h^2 n (n + 1) / 2
    const double covered = kStep * kStep * steps * (steps + 1) / 2;
    const Vec3 fall =
        Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ())) * Vec3(std::cos(slope), 0, -std::sin(slope));
    return {way.dot(fall) / covered, std::atan2(way.cross(fall).norm(), way.dot(fall))};
}

}  // namespace

scene::Scene incline_scene(double slope, double turn, double friction) {
    // the fall line is turned about the vertical; the block's edges keep to the world's, so that
    // nothing is aligned
    const Quat R_table(Eigen::AngleAxisd(turn, Vec3::UnitZ()) *
                       Eigen::AngleAxisd(slope, Vec3::UnitY()));
    const Quat R_block(R_table * Quat(Eigen::AngleAxisd(-turn, Vec3::UnitZ())));
    scene::Scene scene;
    scene::Body plane =
        box_at("slope", {20, 20, 0.1}, {R_table, R_table * Vec3(0, 0, -0.05)}, friction);
    plane.fixed = true;
    scene::Body block = box_at("block", Vec3::Constant(kBlockSize),
                               {R_block, R_table * Vec3(0, 0, kBlockSize / 2)}, friction);
    block.mass = 0.1;
    scene.bodies = {plane, block};
    return scene;
}

scene::Scene stack_scene(int blocks) {
    scene::Scene scene;
    scene.bodies = {table(1, 0.8)};
    for (int i = 0; i < blocks; ++i) {
        scene::Body block = box("block " + std::to_string(i), Vec3::Constant(kBlockSize),
                                {0, 0, (i + 0.5) * kBlockSize}, 0.8);
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
    const double height = 2 * centre_z;  // of a pair's highest corners
    // neighbouring pairs stand clear of each other
    const double outermost = centre_x + u * std::sin(lean) + n * std::cos(lean);
    const double pitch = 2 * outermost + thick;
    scene::Scene scene;
    scene.bodies = {table(1, friction)};
    // decks side by side must not overlap
    const double deck = storeys > 2 ? std::min(length, pitch - thick / 4) : length;
    const auto card = [&](const Vec3& position, double angle, double size) {
        scene::Body body =
            box_at("card " + std::to_string(scene.bodies.size()), {thick, width, size},
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
    scene.bodies = {table(1, friction)};
    for (int i = 0; i < voussoirs; ++i) {
        scene::Body stone;
        stone.name = "voussoir " + std::to_string(i);
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

FrictionFigures bench_friction(const dynamics::Settings& settings, const Progress& progress) {
    FrictionFigures out;
    out.solver = settings.solver;
    double done = 0;
    const auto say = [&](const std::string& what) {
        if (progress) progress(what, done++ / 8);
    };
    say("incline, held");
    out.drift_mm = drift(incline_scene(26 * kDegree, 0, 0.5), settings, 5) * 1e3;
    say("incline, released");
    const double slope = 27 * kDegree;
    out.accel_error = slide(slope, 0, settings).acceleration /
                          (kGravity * (std::sin(slope) - 0.5 * std::cos(slope))) -
                      1;
    say("incline, turned");
    for (int i = 0; i <= 12; ++i) {
        out.direction_error_deg =
            std::max(out.direction_error_deg,
                     slide(30 * kDegree, i * 7.5 * kDegree, settings).off_fall_line / kDegree);
    }
    say("stack");
    out.stack_drift_mm = drift(stack_scene(10), settings, 10) * 1e3;
    say("house of cards");
    out.cards_drift_mm = standing(drift(cards_scene(2), settings, 10, kFallen));
    out.cards_storeys = storeys_held(settings, [&](int storeys) {
        if (progress) progress(fmt::format("house of {} storeys", storeys), done / 8);
    });
    ++done;
    say("arch");
    out.arch_drift_mm = standing(drift(arch_scene(9), settings, 10, kFallen));
    say("creep of a held block");
    BenchSetup setup;
    setup.settings.dynamics = settings;
    setup.settings.coupling.stiffness = 1000;
    setup.hold_time = 60;
    out.creep_mm = measure_hold(setup).slip_mm;
    return out;
}

namespace {

nlohmann::json or_null(const std::optional<double>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}
std::string or_fell(const std::optional<double>& value) {
    return value ? fmt::format("{:.5f}", *value) : "fell";
}

}  // namespace

std::string to_json(const std::vector<FrictionFigures>& figures) {
    nlohmann::ordered_json out;
    for (const FrictionFigures& f : figures) {
        out["solvers"].push_back({{"solver", enum_name(f.solver)},
                                  {"drift_mm", f.drift_mm},
                                  {"accel_error", f.accel_error},
                                  {"direction_error_deg", f.direction_error_deg},
                                  {"stack_drift_mm", f.stack_drift_mm},
                                  {"cards_drift_mm", or_null(f.cards_drift_mm)},
                                  {"cards_storeys", f.cards_storeys},
                                  {"arch_drift_mm", or_null(f.arch_drift_mm)},
                                  {"creep_mm", f.creep_mm}});
    }
    return out.dump(2) + "\n";
}

std::string to_table(const std::vector<FrictionFigures>& figures) {
    std::string out =
        fmt::format("{:21s} {:>10s} {:>10s} {:>10s} {:>10s} {:>10s} {:>7s} {:>10s} {:>10s}\n",
                    "solver", "26 deg mm", "accel err", "dir deg", "stack mm", "cards mm",
                    "storeys", "arch mm", "creep mm");
    for (const FrictionFigures& f : figures) {
        out += fmt::format(
            "{:21s} {:10.5f} {:10.5f} {:10.4f} {:10.5f} {:>10s} {:>7s} {:>10s} {:10.6f}\n",
            enum_name(f.solver), f.drift_mm, f.accel_error, f.direction_error_deg, f.stack_drift_mm,
            or_fell(f.cards_drift_mm),
            f.cards_storeys > 0 ? std::to_string(f.cards_storeys) : "< 2", or_fell(f.arch_drift_mm),
            f.creep_mm);
    }
    return out;
}

}  // namespace dihaptic::measure
