#include "view/joint_marks.h"

#include <cmath>
#include <numbers>

#include "frame/displayed.h"

namespace dihaptic::view {
namespace {

constexpr double kThick = 0.0016;  // thickness of axes and rods [m]
constexpr double kHalfAxis = 0.014;
constexpr double kBall = 0.004;
const char* const kMetal = "#30363f";
const char* const kSpring = "#2a7f62";

Pose shown(const frame::Frame& frame, int body) {
    return body < 0 ? Pose{} : frame::displayed_body(frame, static_cast<size_t>(body));
}

/// A coil spring from a to b, with straight ends.
void add_spring(Solids& out, const Vec3& a, const Vec3& b) {
    constexpr int kTurns = 8;
    constexpr int kPerTurn = 10;
    constexpr double kRadius = 0.005;
    const double length = (b - a).norm();
    if (!(length > 1e-4)) return;
    const Vec3 along = (b - a) / length;
    const Vec3 u = along.unitOrthogonal();
    const Vec3 v = along.cross(u);
    std::vector<Vec3> path{a};
    for (int i = 0; i <= kTurns * kPerTurn; ++i) {
        const double angle = 2 * std::numbers::pi * i / kPerTurn;
        const double way = 0.08 + 0.84 * i / (kTurns * kPerTurn);
        path.push_back(a + way * (b - a) + kRadius * (std::cos(angle) * u + std::sin(angle) * v));
    }
    path.push_back(b);
    out.add(tube(path, 0.0008), {}, ink(kSpring));
}

}  // namespace

JointMark::JointMark(const scene::Joint& joint, const scene::Scene& scene)
    : kind_(joint.row()), springs_(joint.has_axis_spring()) {
    const bool to_world = joint.between.size() == 1;
    a_ = to_world ? -1 : scene.find(joint.between[0]);
    b_ = scene.find(joint.between[to_world ? 0 : 1]);
    const auto pose = [&](int body) {
        return body < 0 ? Pose{} : scene.bodies[static_cast<size_t>(body)].pose();
    };
    const Pose X_AW = pose(a_).inverse();
    const Pose X_BW = pose(b_).inverse();
    p_A_ = X_AW * joint.position;
    p_B_ = X_BW * joint.second_position.value_or(joint.position);
    const Vec3 axis_W = joint.axis.normalized();
    axis_A_ = X_AW.R * axis_W;
    second_B_ = X_BW.R * joint.second_axis.normalized();
    // the spring starts at the middle of the first body or, if there is none, beside the joint
    const Vec3 way = a_ < 0 ? Vec3(-4 * kHalfAxis * axis_W) : Vec3(pose(a_).p - joint.position);
    from_A_ = p_A_ + axis_A_ * axis_W.dot(way);
}

void JointMark::add_to(Solids& out, const frame::Frame& frame, const gl::Model& ball) const {
    const Pose X_WA = shown(frame, a_);
    const Pose X_WB = shown(frame, b_);
    const Vec3 p = X_WA * p_A_;
    const Vec3 q = X_WB * p_B_;
    const Vec3 axis = X_WA.R * axis_A_;
    const auto add_axis = [&](const Vec3& along) {
        out.add_line(p - kHalfAxis * along, p + kHalfAxis * along, kThick, ink(kMetal));
    };
    const auto add_ball = [&](double radius, const char* tint) {
        out.add_ball(ball, p, radius, ink(tint));
    };
    using scene::Coordinate;
    using scene::Turning;
    if (kind_.coordinate == Coordinate::displacement) return add_slider(out, X_WA, X_WB);
    if (kind_.coordinate == Coordinate::distance)
        return springs_ ? add_spring(out, p, q) : out.add_line(p, q, kThick / 2, ink(kMetal));
    const bool two = kind_.turning == Turning::about_two_axes;
    if (two || kind_.turning == Turning::about_axis) add_axis(axis);
    if (two) add_axis(X_WB.R * second_B_);
    if (kind_.yields || (kind_.has_coordinate() && springs_)) {
        add_ball(0.8 * kBall, kSpring);
    } else if (kind_.turning == Turning::any || kind_.turning == Turning::none) {
        add_ball(kind_.turning == Turning::any ? kBall : 0.6 * kBall, kMetal);
    }
}

void JointMark::add_slider(Solids& out, const Pose& X_WA, const Pose& X_WB) const {
    const Vec3 axis = X_WA.R * axis_A_;
    const Vec3 from = X_WA * from_A_;
    const Vec3 stretch = axis * axis.dot(X_WB.p - from);
    constexpr double kShort = 0.002;  // length below which a spring cannot be seen
    if (springs_ && stretch.norm() > kShort) {
        add_spring(out, from, from + stretch);
        return;
    }
    const Vec3 p = X_WA * p_A_;
    const Vec3 to = p + axis * axis.dot(X_WB * p_B_ - p);
    out.add_line(p - kHalfAxis * axis, to + kHalfAxis * axis, kThick / 2, ink(kMetal));
}

std::vector<JointMark> joint_marks(const scene::Scene& scene) {
    std::vector<JointMark> out;
    for (const scene::Joint& joint : scene.joints) out.emplace_back(joint, scene);
    return out;
}

}  // namespace dihaptic::view
