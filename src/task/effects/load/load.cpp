#include "task/effects/load/load.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "task/effects/factor.h"
#include "task/plan/names.h"

namespace dihaptic::task {
namespace {

constexpr double kRoundingShare = 1e-9;  // relative rounding error of the computed eigenvalues

/// Returns the largest eigenvalue of the symmetric part of the matrix, the only part that supplies
/// or absorbs energy.
double most_driving(const Mat3& matrix) {
    const Mat3 symmetric = (matrix + matrix.transpose()) / 2;
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(symmetric, Eigen::EigenvaluesOnly);
    const double most = solver.eigenvalues().maxCoeff();
    return most > kRoundingShare * matrix.norm() ? most : 0;
}

}  // namespace

bool LoadSpec::pushes_by_velocity() const {
    return kind == LoadKind::viscous || kind == LoadKind::curl ||
           (kind == LoadKind::general && !B.isZero(0));
}

Load::Load(const LoadSpec& spec, const Names& names, const scene::Scene& scene,
           Diagnostics& diagnostics)
    : spec_(spec) {
    if (spec.kind == LoadKind::link) {
        spec_.on = spec.between;
        check_link(diagnostics);
    }
    check_things(names, scene, diagnostics);
    switch (spec.kind) {
        case LoadKind::constant:
            if (spec.force == FormulaVec3{} && spec.torque == FormulaVec3{}) {
                diagnostics.error(spec.place, "force", "is missing: the load would do nothing",
                                  "Add e.g. force_N: [0, 0, -1], or torque_Nm.");
            }
            break;
        case LoadKind::viscous:
        case LoadKind::curl:
            if (spec.damping == 0) {
                diagnostics.error(spec.place, "damping", "is missing: the field would do nothing",
                                  "Add e.g. damping_Ns_m: 10.");
            }
            if (spec.kind == LoadKind::curl)
                direction_ = axis_of(spec.axis, spec.place, "axis", diagnostics);
            break;
        case LoadKind::general:
            origin_ = spec.about.index;
            check_general(diagnostics);
            break;
        case LoadKind::spring:
        case LoadKind::channel:
            look_up_place(names, diagnostics);
            check_spring(diagnostics);
            break;
        case LoadKind::link:
            break;
    }
}

void Load::check_link(Diagnostics& diagnostics) const {
    if (spec_.between.size() != 2) {
        diagnostics.error(
            spec_.place, "between",
            fmt::format("has {} items, but a link has two ends", spec_.between.size()),
            "Name two bodies or fingers, e.g. between: [A index, B index].");
    }
    if (spec_.stiffness == 0 && spec_.damping == 0) {
        diagnostics.error(spec_.place, "stiffness", "is missing, and so is 'damping'",
                          "Add e.g. stiffness_N_m: 100.");
    }
}

void Load::check_things(const Names& names, const scene::Scene& scene,
                        Diagnostics& diagnostics) const {
    if (spec_.on.empty() && spec_.kind != LoadKind::link) {
        diagnostics.error(spec_.place, "on", "has no items",
                          "Name fingers and bodies, e.g. on: [thumb, index].");
    }
    const char* const key = spec_.kind == LoadKind::link ? "between" : "on";
    const std::vector<int>& on = spec_.on.indices;
    for (auto i = on.begin(); i != on.end(); ++i) {
        const auto thing = static_cast<size_t>(*i);
        const std::string& name = names.all<Thing>()[thing];
        if (thing < scene.bodies.size() && !scene.bodies[thing].moves_at_all()) {
            diagnostics.error(spec_.place, key, "'" + name + "' cannot move",
                              "Name a movable body, or a finger.");
        }
        if (std::find(on.begin(), i, *i) != i) {
            diagnostics.error(spec_.place, key, "'" + name + "' is named twice",
                              "Name it once, and make the load stronger if needed.");
        }
    }
}

void Load::look_up_place(const Names& names, Diagnostics& diagnostics) {
    const auto useless = [&](const char* key, bool given, const char* remedy) {
        if (given) diagnostics.error(spec_.place, key, "cannot be used here", remedy);
    };
    const bool channel = spec_.kind == LoadKind::channel;
    if (spec_.about.empty()) {
        between_ = true;
        origin_ = names.need(spec_.from, spec_.place, "from", diagnostics);
        names.need(spec_.to, spec_.place, "to", diagnostics);
        shape_ = spec_.free ? Shape::plane : Shape::line;
        if (spec_.free) direction_ = axis_of(spec_.free, spec_.place, "free", diagnostics);
        const char* const remedy = "Leave it out, or give 'about' instead of 'from' and 'to'.";
        useless("normal", spec_.normal.has_value(), remedy);
        useless("axis", spec_.axis.has_value() && !channel, remedy);
        return;
    }
    origin_ = spec_.about.index;
    const char* const remedy = "Leave it out: 'about' is the region for the line or plane.";
    useless("from", !spec_.from.empty(), remedy);
    useless("to", !spec_.to.empty(), remedy);
    useless("free", spec_.free.has_value(), remedy);
    if (spec_.normal && spec_.axis) {
        diagnostics.error(spec_.place, "normal", "defines a plane, but 'axis' defines a line",
                          "Keep only one of them.");
    } else if (spec_.normal) {
        shape_ = Shape::plane;
        direction_ = axis_of(spec_.normal, spec_.place, "normal", diagnostics);
    } else if (spec_.axis) {
        shape_ = Shape::line;
        direction_ = axis_of(spec_.axis, spec_.place, "axis", diagnostics);
    } else if (channel) {
        diagnostics.error(
            spec_.place, "normal", "is missing: a channel needs a line or plane",
            "Add e.g. normal: [0, 0, 1], or name 'from' and 'to' instead of 'about'.");
    }
}

void Load::check_spring(Diagnostics& diagnostics) const {
    const bool channel = spec_.kind == LoadKind::channel;
    if (spec_.stiffness == 0 || (channel && spec_.stiffness.value < 0)) {
        diagnostics.error(
            spec_.place, "stiffness",
            channel ? "is missing: a channel needs a stiffness"
                    : "is missing: a spring needs a stiffness",
            channel ? "Add e.g. stiffness_N_m: 1000." : "Add e.g. stiffness_N_m: 50.");
    }
    if (spec_.stiffness.value < 0 && !spec_.zone) {
        diagnostics.error(spec_.place, "stiffness",
                          "is negative: the load would grow without limit as it pushes away",
                          "Add e.g. safe_within_mm: 50, beyond which the load fades to zero.");
    }
    if (!spec_.one_sided) return;
    if (shape_ != Shape::plane || between_) {
        diagnostics.error(
            spec_.place, "one_sided", "needs a plane with a normal",
            "Add e.g. normal: [0, 0, 1], the direction of the push, or leave it out.");
    }
    if (spec_.stiffness.value < 0) {
        diagnostics.error(spec_.place, "one_sided", "a wall cannot have a negative stiffness",
                          "Make the stiffness positive, or leave out one_sided.");
    }
}

void Load::check_general(Diagnostics& diagnostics) {
    if (spec_.A.isZero(0) && spec_.B.isZero(0) && spec_.force == FormulaVec3{}) {
        diagnostics.error(spec_.place, "A", "is missing, and so are 'B' and 'force'",
                          "Add e.g. B_Ns_m: [[0, -13, 0], [13, 0, 0], [0, 0, 0]].");
    }
    if (spec_.about.empty() && (!spec_.A.isZero(0) || spec_.zone)) {
        diagnostics.error(spec_.place, "about",
                          "is missing: positions are relative to a region's centre",
                          "Name a region, e.g. about: start.");
    }
    if (const double driving = most_driving(spec_.A); driving > 0 && !spec_.zone) {
        diagnostics.error(
            spec_.place, "A",
            fmt::format(
                "pushes away, like a spring of {:.3g} N/m: the load would grow without limit",
                -driving),
            "Add e.g. safe_within_mm: 50, beyond which the load fades to zero.");
    }
}

bool Load::is_computed() const {
    const auto computed = [](const FormulaVec3& v) {
        return v[0].computed() || v[1].computed() || v[2].computed();
    };
    return spec_.length.computed() || spec_.damping.computed() || spec_.stiffness.computed() ||
           spec_.delay.computed() || computed(spec_.force) || computed(spec_.torque);
}

double Load::longest_delay() const {
    return spec_.delay.computed() ? spec_.delay.field.max : spec_.delay.value;
}

std::optional<Vec3> Load::axis() const {
    if (spec_.kind != LoadKind::curl) return {};
    return direction_;
}

Load::Demand Load::demand() const {
    Demand out;
    out.force = value(spec_.force).norm();
    out.torque = value(spec_.torque).norm();
    // a load that holds a hand in place may be as stiff as the device allows
    out.holds = spec_.kind == LoadKind::channel || spec_.one_sided;
    out.springs = out.holds || spec_.kind == LoadKind::spring || spec_.kind == LoadKind::link;
    if (spec_.kind == LoadKind::general) {
        out.stiffness = spec_.A.operatorNorm();
        out.damping = spec_.B.operatorNorm();
        out.driving = most_driving(spec_.B);
    } else {
        out.stiffness = std::abs(spec_.stiffness.value);
        out.damping = std::abs(spec_.damping.value);
        if (spec_.kind != LoadKind::curl) out.driving = std::max(0.0, -spec_.damping.value);
    }
    if (out.stiffness == 0) return out;
    if (!spec_.zone) {
        out.force = std::numeric_limits<double>::infinity();
        return out;
    }
    out.force += out.stiffness * *spec_.zone;
    // while the load fades with distance, it has negative stiffness if it attracts, and positive
    // stiffness if it repels
    out.stiffness = std::max(out.stiffness, out.force / spec_.fade);
    return out;
}

Wrench Load::act(double share, std::span<const Vec3> regions_W,
                 const Motion& motion) const noexcept {
    switch (spec_.kind) {
        case LoadKind::constant:
            return {share * value(spec_.force), share * value(spec_.torque)};
        case LoadKind::viscous:
            return {-share * spec_.damping.value * motion.v_W, Vec3::Zero()};
        case LoadKind::curl:
            return {share * spec_.damping.value * direction_.cross(motion.v_W), Vec3::Zero()};
        case LoadKind::general: {
            const Vec3 arm = origin_ < 0
                                 ? Vec3::Zero()
                                 : Vec3(motion.p_W - regions_W[static_cast<size_t>(origin_)]);
            return {share * left_at(arm.norm()) *
                        (value(spec_.force) + spec_.A * arm + spec_.B * motion.v_W),
                    Vec3::Zero()};
        }
        case LoadKind::spring:
        case LoadKind::channel:
            return {pull(share, regions_W, motion), Vec3::Zero()};
        case LoadKind::link:  // the force depends on two motions
            break;
    }
    return {};
}

void Load::order_link(double share, const Motions& motions, frame::TaskFrame& out) const noexcept {
    if (on().size() != 2) return;
    const Motion* const a = motions.of(on()[0], spec_.delay.value);
    const Motion* const b = motions.of(on()[1], spec_.delay.value);
    if (a == nullptr || b == nullptr) return;
    const Vec3 d = a->p_W - b->p_W;
    const double distance = d.norm();
    if (distance <= 0) return;
    const Vec3 u = d / distance;
    const double stretch = distance - spec_.length.value;
    if ((spec_.acts == LinkActs::pulls && stretch <= 0) ||
        (spec_.acts == LinkActs::pushes && stretch >= 0))
        return;
    const double rate = (a->v_W - b->v_W).dot(u);
    double pull = share * (spec_.stiffness.value * stretch + spec_.damping.value * rate);
    if (spec_.acts == LinkActs::pulls) pull = std::max(pull, 0.0);
    if (spec_.acts == LinkActs::pushes) pull = std::min(pull, 0.0);
    add(out.loads, {on()[0], -pull * u, Vec3::Zero()});
    add(out.loads, {on()[1], pull * u, Vec3::Zero()});
}

void Load::order(double share, std::span<const Vec3> regions_W, const Motions& motions,
                 frame::TaskFrame& out) const noexcept {
    if (spec_.kind == LoadKind::link) return order_link(share, motions, out);
    for (const int thing : on()) {
        const Motion* const motion = motions.of(thing, spec_.delay.value);
        if (motion == nullptr) continue;
        const Wrench wrench = act(share, regions_W, *motion);
        add(out.loads, {thing, wrench.force, wrench.torque});
    }
}

Mat3 Load::velocity_gain() const {
    Mat3 gain = Mat3::Zero();
    if (spec_.kind == LoadKind::general) return spec_.B;
    if (spec_.kind != LoadKind::viscous && spec_.kind != LoadKind::curl) return gain;
    for (int k = 0; k < 3; ++k) gain.col(k) = act(1, {}, {Vec3::Zero(), Vec3::Unit(k)}).force;
    return gain;
}

/// The force of a spring or channel.
Vec3 Load::pull(double share, std::span<const Vec3> regions_W,
                const Motion& motion) const noexcept {
    const Vec3& centre = regions_W[static_cast<size_t>(origin_)];
    const Vec3 arm = motion.p_W - centre;
    Vec3 direction = direction_;
    if (between_) {
        const Vec3 way = regions_W[static_cast<size_t>(spec_.to.index)] - centre;
        const double length = way.norm();
        if (length <= 0) return Vec3::Zero();
        direction = way / length;
        if (shape_ == Shape::plane) direction = direction.cross(direction_).stableNormalized();
    }
    Vec3 off = arm;
    Vec3 across = motion.v_W;
    if (shape_ == Shape::line) {
        off = arm - arm.dot(direction) * direction;
        across = motion.v_W - motion.v_W.dot(direction) * direction;
    } else if (shape_ == Shape::plane) {
        off = arm.dot(direction) * direction;
        across = motion.v_W.dot(direction) * direction;
    }
    if (spec_.one_sided && off.dot(direction) >= 0) return Vec3::Zero();
    const Vec3 force = -share * (spec_.stiffness.value * off + spec_.damping.value * across);
    if (spec_.one_sided && force.dot(direction) < 0) return Vec3::Zero();  // a wall only pushes
    return spec_.zone ? Vec3(left_at(off.norm()) * force) : force;
}

/// Returns the share of the load that remains at a distance from its point, line or plane.
double Load::left_at(double distance) const noexcept {
    if (!spec_.zone) return 1;
    return std::clamp(1 - (distance - *spec_.zone) / spec_.fade, 0.0, 1.0);
}

namespace {

std::string vector_in_words(const Vec3& v) {
    return in_words(as_formula(v));
}

/// Returns the rows of a matrix, such as "(1, 0, 0; 0, 1, 0; 0, 0, 1)".
std::string matrix_in_words(const Mat3& m) {
    std::vector<std::string> rows;
    for (int i = 0; i < 3; ++i)
        rows.push_back(fmt::format("{:.6g}, {:.6g}, {:.6g}", m(i, 0), m(i, 1), m(i, 2)));
    return fmt::format("({})", fmt::join(rows, "; "));
}

/// Returns the point, line or plane to which a spring or channel pulls, in words.
std::string place_of_load_in_words(const LoadSpec& spec) {
    const std::string through = spec.about.empty() ? "" : " through " + spec.about;
    if (spec.normal)
        return fmt::format("the plane across {}{}", vector_in_words(*spec.normal), through);
    const bool is_led = !spec.from.empty() && !spec.to.empty();
    const std::string led =
        is_led ? fmt::format(" from {} to {}", std::string(spec.from), std::string(spec.to)) : "";
    if (spec.free)
        return fmt::format("the plane along {}{}", vector_in_words(*spec.free), led + through);
    if (spec.axis) return fmt::format("the line along {}{}", vector_in_words(*spec.axis), through);
    if (is_led) return "the line" + led;
    return spec.about;
}

std::string load_in_words(const LoadSpec& spec) {
    const std::string place = place_of_load_in_words(spec);
    const std::string to = place.empty() ? "" : " to " + place;
    switch (spec.kind) {
        case LoadKind::constant:
            return fmt::format("constant force {} N", in_words(spec.force)) +
                   (spec.torque == FormulaVec3{} ? ""
                                                 : fmt::format(", {} N*m", in_words(spec.torque)));
        case LoadKind::viscous:
        case LoadKind::curl:
            return fmt::format("{} field of {} N*s/m", enum_name(spec.kind),
                               in_words(spec.damping)) +
                   (spec.axis ? " about " + vector_in_words(*spec.axis) : "");
        case LoadKind::general:
            return fmt::format("general field of {} N, {} N/m and {} N*s/m", in_words(spec.force),
                               matrix_in_words(spec.A), matrix_in_words(spec.B));
        case LoadKind::spring:
            return fmt::format("spring of {} N/m{}", in_words(spec.stiffness), to);
        case LoadKind::channel:
            return fmt::format("force channel of {} N/m{}", in_words(spec.stiffness), to);
        case LoadKind::link:
            return fmt::format("link of {} N/m between {} and {}", in_words(spec.stiffness),
                               spec.between.front(), spec.between.back());
    }
    return "";
}

}  // namespace

void say(const LoadSpec& spec, std::vector<std::string>& out) {
    std::string text = load_in_words(spec);
    const std::vector<std::string> on(spec.on.begin(), spec.on.end());
    if (!on.empty()) text += fmt::format(", on {}", fmt::join(on, " and "));
    if (spec.delay != 0) text += fmt::format(", {} ms late", in_words(spec.delay, 1e-3));
    out.push_back(text);
}

}  // namespace dihaptic::task
