#include "dynamics/bullet/joints.h"

#include <LinearMath/btTransformUtil.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dynamics/bullet/shape.h"

namespace dihaptic::dynamics {
namespace {

using contact::ProblemJoint;
using contact::Vec6;
using scene::Coordinate;
using scene::Sliding;
using scene::Turning;

/// Joints are no stiffer than steel. Otherwise, a mechanism would be hurled apart when it passes
/// through a singular configuration, in which its joints do not determine its motion, such as a
/// parallelogram that lies flat.
constexpr double kStiffness = 1e9;      // [N/m]
constexpr double kTurnStiffness = 1e7;  // [N*m/rad]
/// Maximum speed at which a body that was placed in violation of its joint is pulled back.
constexpr double kPull = 0.5;    // [m/s]
constexpr double kTurnPull = 5;  // [rad/s]
constexpr double kNone = std::numeric_limits<double>::infinity();

Pose pose_of(const Joints::Side& side) {
    return side.body == nullptr ? Pose{} : from_bullet(side.body->getWorldTransform());
}

/// The pose that a body reaches in a step of h at these velocities.
Pose moved(const Joints::Side& side, const Vec6& v, double h) {
    if (side.fixed) return pose_of(side);
    btTransform out;
    btTransformUtil::integrateTransform(side.body->getWorldTransform(),
                                        to_bullet(Vec3(v.head<3>())), to_bullet(Vec3(v.tail<3>())),
                                        h, out);
    return from_bullet(out);
}

Vec6 velocity_of(const Joints::Side& side) {
    Vec6 out = Vec6::Zero();
    if (!side.fixed)
        out << from_bullet(side.body->getLinearVelocity()),
            from_bullet(side.body->getAngularVelocity());
    return out;
}

/// Sets a row to the relative rotation about n.
void turn(ProblemJoint& rows, int row, const Vec3& n) {
    rows.J_b.row(row).tail<3>() = n.transpose();
    rows.J_a.row(row).tail<3>() = -n.transpose();
}

/// Whether a joint prevents translation along the k-th axis of F.
bool holds(Sliding sliding, int k) {
    return sliding == Sliding::none || (sliding == Sliding::along_axis && k > 0);
}
/// Whether a joint prevents rotation about its k-th turning_direction().
bool holds(Turning turning, int k) {
    return turning == Turning::none || (turning == Turning::about_axis && k > 0) ||
           (turning == Turning::about_two_axes && k == 0);
}
/// The direction about which the k-th angular row of a joint acts. F and G are the axes of the
/// joint's two frames.
Vec3 turning_direction(Turning turning, const Mat3& F, const Mat3& G, int k) {
    if (turning == Turning::about_axis) return G.col(0).cross(F.col(k));
    if (turning == Turning::about_two_axes) return G.col(1).cross(F.col(0));
    return F.col(k);
}

/// Makes a row ineffective.
void close(ProblemJoint& rows, int row) {
    rows.low[row] = rows.high[row] = 0;
}

/// Returns the rotation that maps the x axis to `axis`, and the y axis as closely as possible to
/// `second`.
Quat frame_along(const Vec3& axis, const Vec3& second) {
    Mat3 R;
    R.col(0) = axis.normalized();
    Vec3 across = second - second.dot(R.col(0)) * R.col(0);
    if (across.norm() < 1e-6 * second.norm()) across = R.col(0).unitOrthogonal();
    R.col(1) = across.normalized();
    R.col(2) = R.col(0).cross(R.col(1));
    return Quat(R);
}

/// Disables a bushing's rows along and about axes that have neither a spring nor a damper.
void close_free(const scene::Joint& bushing, std::span<ProblemJoint> rows) {
    for (int k = 0; k < ProblemJoint::kRows; ++k) {
        if (bushing.stiffnesses[k] == 0 && bushing.dampings[k] == 0) close(rows[0], k);
        if (bushing.turn_stiffnesses[k] == 0 && bushing.turn_dampings[k] == 0) close(rows[1], k);
    }
}

double inside(const ProblemJoint& rows, int row, const Vec6& a, const Vec6& b) {
    return rows.J_a.row(row).dot(a) + rows.J_b.row(row).dot(b);
}

/// The inverse masses that the rows along and about the axes would move, each considered
/// separately.
Vec6 along_rows(const contact::ContactProblem& problem, std::span<const ProblemJoint> rows) {
    Vec6 out = Vec6::Zero();
    for (int k = 0; k < 6; ++k) {
        const ProblemJoint& from = rows[static_cast<size_t>(k / 3)];
        const auto add = [&](int body, const auto& J) {
            if (body == contact::kFixed) return;
            out[k] += J * problem.bodies[static_cast<size_t>(body)].inverse_mass * J.transpose();
        };
        add(from.a, from.J_a.row(k % 3));
        add(from.b, from.J_b.row(k % 3));
    }
    return out;
}

/// The inverse mass that is moved by the joint's coordinate while its other rows hold.
double along_coordinate(const contact::ContactProblem& problem,
                        std::span<const ProblemJoint> rows) {
    constexpr int kHeld = 2 * ProblemJoint::kRows;
    using Matrix = Eigen::Matrix<double, kHeld + 1, 6>;
    Eigen::Matrix<double, kHeld + 1, kHeld + 1> W;
    W.setZero();
    for (const bool second : {false, true}) {
        const int body = second ? rows[0].b : rows[0].a;
        if (body == contact::kFixed) continue;
        Matrix J;
        for (int k = 0; k < ProblemJoint::kRows; ++k) {
            for (int e = 0; e < 2; ++e) {
                const ProblemJoint& from = rows[static_cast<size_t>(e)];
                J.row(ProblemJoint::kRows * e + k) = second ? from.J_b.row(k) : from.J_a.row(k);
            }
        }
        J.row(kHeld) = second ? rows[2].J_b.row(0) : rows[2].J_a.row(0);
        W += J * problem.bodies[static_cast<size_t>(body)].inverse_mass * J.transpose();
    }
    for (int k = 0; k < kHeld; ++k) {
        if (W(k, k) <= 0) W(k, k) = 1;  // this row has no effect
    }
    const auto held = W.topLeftCorner<kHeld, kHeld>();
    const Eigen::Matrix<double, kHeld, 1> across = W.topRightCorner<kHeld, 1>();
    return std::max(0.0, W(kHeld, kHeld) - across.dot(held.ldlt().solve(across)));
}

}  // namespace

void Joints::add(const scene::Joint& spec, const Side& a, const Side& b) {
    const Vec3 second = spec.row().turning == Turning::about_two_axes
                            ? spec.second_axis
                            : Vec3(spec.axis.unitOrthogonal());
    const Quat R_WF =
        spec.row().yields ? rotation_xyz(spec.rotation) : frame_along(spec.axis, second);
    const Pose X_WF{R_WF, spec.position};
    const Pose X_WG{X_WF.R, spec.second_position.value_or(spec.position)};
    Joint& added = joints_.emplace_back(
        Joint{spec, a, b, pose_of(a).inverse() * X_WF, pose_of(b).inverse() * X_WG});
    const double distance = (X_WG.p - X_WF.p).norm();
    if (spec.is_rod()) added.spec.low = added.spec.high = distance;
    states_.push_back({.kind = spec.kind, .position = spec.is_distance() ? distance : 0});
}

Joints::Gaps Joints::gaps(const Joint& joint, const Pose& X_WA, const Pose& X_WB,
                          double q_near) noexcept {
    const Pose X_WF = X_WA * joint.X_AF;
    const Pose X_WG = X_WB * joint.X_BF;
    const Pose X_FG = X_WF.inverse() * X_WG;
    const Mat3 R = X_FG.R.toRotationMatrix();
    Gaps out;
    out.linear = X_FG.p;
    const scene::JointKindRow& kind = joint.spec.row();
    if (kind.yields) {
        out.angular = rotation_vector(X_FG.R);
    } else if (kind.turning == Turning::none) {
        out.angular = (X_FG.R.w() < 0 ? -2 : 2) * X_FG.R.vec();
    } else if (kind.turning == Turning::about_axis) {
        out.angular.tail<2>() = R.col(0).tail<2>();
    } else if (kind.turning == Turning::about_two_axes) {
        out.angular[0] = R(0, 1);
    }
    if (kind.coordinate == Coordinate::angle) {
        const double turned = std::atan2(R(2, 1), R(1, 1));
        constexpr double kTurn = 2 * std::numbers::pi;
        out.q = turned + kTurn * std::round((q_near - turned) / kTurn);
    } else if (kind.has_coordinate()) {
        out.q = kind.has_axis() ? X_FG.p.x() : X_FG.p.norm();
    }
    return out;
}

Vec3 Joints::direction(const Joint& joint, const Pose& X_WA, const Pose& X_WB) noexcept {
    if (!joint.spec.is_distance()) return X_WA.R * joint.X_AF.R * Vec3::UnitX();
    constexpr double kTogether = 1e-9;  // if the points coincide, any direction is valid
    const Vec3 between = X_WB * joint.X_BF.p - X_WA * joint.X_AF.p;
    const double distance = between.norm();
    return distance > kTogether ? Vec3(between / distance)
                                : Vec3(X_WA.R * joint.X_AF.R * Vec3::UnitX());
}

void Joints::fill(const Joint& joint, const Pose& X_WA, const Pose& X_WB,
                  std::span<ProblemJoint> rows) noexcept {
    const Pose X_WF = X_WA * joint.X_AF;
    const Pose X_WG = X_WB * joint.X_BF;
    const Mat3 F = X_WF.R.toRotationMatrix();
    const Mat3 G = X_WG.R.toRotationMatrix();
    const auto along = [&](ProblemJoint& out, int row, const Vec3& d) {
        out.J_b.row(row) << d.transpose(), (X_WG.p - X_WB.p).cross(d).transpose();
        // the axes are fixed to the first body, and turn with it
        out.J_a.row(row) << -d.transpose(), -(X_WG.p - X_WA.p).cross(d).transpose();
    };
    const scene::JointKindRow& kind = joint.spec.row();
    for (int k = 0; k < 3; ++k) {
        if (holds(kind.sliding, k)) {
            along(rows[0], k, F.col(k));
        } else {
            close(rows[0], k);
        }
        if (holds(kind.turning, k)) {
            turn(rows[1], k, turning_direction(kind.turning, F, G, k));
        } else {
            close(rows[1], k);
        }
        if (joint.spec.slides()) {
            along(rows[2], k, direction(joint, X_WA, X_WB));
        } else if (kind.has_coordinate()) {
            turn(rows[2], k, F.col(0));
        }
        close(rows[2], k);
    }
    if (kind.yields) close_free(joint.spec, rows);
}

namespace {

/// Sets a row for a spring and a damper; u is the previous rate of stretch. At the end of a step
/// without motion, the spring would resist with `force`, plus `stiffness` per unit of further
/// stretch.
void ask_of_spring(double force, double stiffness, double damping, double inverse_mass, double u,
                   double h, int k, ProblemJoint& row) {
    const double s = h * h * stiffness * inverse_mass;
    const double damped = s / (1 + s);
    const double ahead = h * (1 + 3 * damped) / 4;
    const double in_step = h * (damping + ahead * stiffness);
    if (in_step <= 0) {
        row.low[k] = row.high[k] = -h * force;
        return;
    }
    row.low[k] = -kNone;
    row.high[k] = kNone;
    row.compliance[k] = 1 / in_step;
    row.bias[k] = h * (force - stiffness * ahead * (1 - damped) * u) / in_step;
}

}  // namespace

void Joints::ask_of_bushing(const Joint& joint, const Gaps& then, double h, const Vec6& v_a,
                            const Vec6& v_b, std::span<ProblemJoint> rows) noexcept {
    for (int k = 0; k < 6; ++k) {
        ProblemJoint& row = rows[static_cast<size_t>(k / 3)];
        const int axis = k % 3;
        if (row.low[axis] == row.high[axis]) continue;
        const scene::Joint& spec = joint.spec;
        const bool turns = k >= 3;
        const double gap = turns ? then.angular[axis] : then.linear[axis];
        const double stiffness =
            (turns ? spec.turn_stiffnesses : spec.stiffnesses)[axis] * joint.properties.stiffness;
        const double damping =
            (turns ? spec.turn_dampings : spec.dampings)[axis] * joint.properties.damping;
        ask_of_spring(stiffness * (gap - h * inside(row, axis, v_a, v_b)), stiffness, damping,
                      joint.inverse_masses[k], joint.rates[k], h, axis, row);
    }
}

double Joints::stored(const Joint& joint, double h, const Vec3& v_W, const Vec3& w_W) noexcept {
    const scene::Joint& spec = joint.spec;
    const auto& rows = joint.rows;
    double energy = 0;
    if (spec.row().yields) {
        for (int k = 0; k < 3; ++k) {
            const double gap =
                joint.start.linear[k] + h / 2 * rows[0].J_b.row(k).head<3>().dot(v_W);
            const double turn =
                joint.start.angular[k] + h / 2 * rows[1].J_b.row(k).tail<3>().dot(w_W);
            energy += spec.stiffnesses[k] * gap * gap + spec.turn_stiffnesses[k] * turn * turn;
        }
        return joint.properties.stiffness * energy / 2;
    }
    if (!spec.has_axis_spring()) return 0;
    const double rate = spec.slides() ? rows[2].J_b.row(0).head<3>().dot(v_W)
                                      : rows[2].J_b.row(0).tail<3>().dot(w_W);
    const double stretch = joint.start.q + h / 2 * rate - spec.rest;
    return joint.properties.stiffness * (spec.curve.is_empty()
                                             ? spec.stiffness * stretch * stretch / 2
                                             : spec.curve.energy(stretch));
}

Books::Exchange Joints::exchange(size_t i, double h, const Books::Meeting& meeting) const noexcept {
    const Joint& joint = joints_[i];
    const JointState& state = states_[i];
    Books::Exchange out{.a = joint.a.item,
                        .b = joint.b.item,
                        .p_W = joint.acts_at_W,
                        .impulse_W = h * state.force_W,
                        .moment_W = h * state.torque_W,
                        .joint = static_cast<int>(i)};
    out.stored_before = stored(joint, -h, meeting.v_before(), meeting.w_before());
    out.stored_after = stored(joint, h, meeting.v_after, meeting.w_after);
    if (!joint.led_from) return out;
    const auto& axis = joint.rows[2].J_b.row(0);
    const double rate = joint.spec.slides() ? axis.head<3>().dot(meeting.v_mean)
                                            : axis.tail<3>().dot(meeting.w_mean);
    out.given = joint.impulses[2][1] * rate;
    return out;
}

namespace {

/// The largest speed at which a body is pulled back along the joint's coordinate.
double most_pull(const scene::Joint& spec) {
    return spec.slides() ? kPull : kTurnPull;
}

/// The speed at which a coordinate must change so that it is not `off` from a stop at the end of
/// the step [m/s], [rad/s]. The part of `off` that is there at the start, `off_now`, is undone
/// slowly; the rest is due to the turning of the joint's direction in the step, however fast that
/// is.
double speed_to_stop(double off, double off_now, double h, double pull) {
    if (std::abs(off) <= pull * h) return off / h;
    return std::clamp(off_now / h, -pull, pull) + (off - off_now) / h;
}

}  // namespace

/// Sets the rows of a joint coordinate, which is now `q_now` and would be q at the end of a step
/// without motion: a spring with its damper, dry friction, and the nearer stop. Returns the change
/// in the bias of a rod, and of a stop against which the coordinate turns fast.
double Joints::ask_of_coordinate(size_t i, double q, double q_now, double h,
                                 ProblemJoint& row) const noexcept {
    enum { kSpring, kMotor, kStop };
    const Joint& joint = joints_[i];
    const scene::Joint& spec = joint.spec;
    scene::SpringCurve::Point at{spec.stiffness * (q - spec.rest), spec.stiffness};
    if (!spec.curve.is_empty()) at = spec.curve.at(q - spec.rest);
    // in a falling part of the curve, a negative stiffness at the end of the step would be unstable
    ask_of_spring(at.resistance * joint.properties.stiffness,
                  std::max(0.0, at.stiffness) * joint.properties.stiffness,
                  spec.damping * joint.properties.damping, joint.inverse_mass, states_[i].velocity,
                  h, kSpring, row);
    ask_of_motor(joint, q, h, kMotor, row);
    if (!spec.low || !spec.high || *spec.low != *spec.high)
        return ask_of_stop(spec, q, q_now, h, kStop, row);
    row.low[kStop] = -kNone;
    row.high[kStop] = kNone;
    row.compliance[kStop] = 1 / (h * h * (spec.slides() ? kStiffness : kTurnStiffness));
    const double bias = speed_to_stop(q - *spec.low, q_now - *spec.low, h, most_pull(spec));
    return std::abs(bias - std::exchange(row.bias[kStop], bias));
}

/// Sets row k: the nearer one of a coordinate's stops, or none. Returns as ask_of_coordinate()
/// does.
double Joints::ask_of_stop(const scene::Joint& spec, double q, double q_now, double h, int k,
                           ProblemJoint& row) noexcept {
    const double pull = most_pull(spec);
    const double above = spec.low ? q - *spec.low : kNone;
    const double below = spec.high ? *spec.high - q : kNone;
    row.low[k] = below < above ? -kNone : 0;
    row.high[k] = above <= below && spec.low ? kNone : 0;
    // the distance to the stop, or what must be undone beyond it
    const double gap = std::min(above, below);
    const double gap_now = below < above ? *spec.high - q_now : spec.low ? q_now - *spec.low : 0;
    const double speed = gap > 0 ? gap / h : speed_to_stop(gap, std::min(gap_now, 0.0), h, pull);
    const double bias = below < above ? -speed : spec.low ? speed : 0;
    const double change = std::abs(bias - std::exchange(row.bias[k], bias));
    return gap < -pull * h ? change : 0;
}

void Joints::ask_of_motor(const Joint& joint, double q, double h, int k,
                          ProblemJoint& row) noexcept {
    if (!joint.motor || !joint.motor->position) {
        const double friction = joint.spec.friction * joint.properties.friction;
        row.low[k] = -h * friction;
        row.high[k] = h * friction;
        return;
    }
    const double to = *joint.motor->position;
    const double most = joint.motor->most_force;
    row.low[k] = -h * most;
    row.high[k] = h * most;
    // limit the speed, relative to the target's motion, so that half of the motor's force can stop
    // the joint at the target
    const double led = joint.led_from ? std::abs(to - *joint.led_from) / h : 0;
    const double fastest = led + std::sqrt(most * joint.inverse_mass * std::abs(q - to));
    row.bias[k] = std::clamp((q - to) / h, -fastest, fastest);
    row.compliance[k] = 1 / (h * h * (joint.spec.slides() ? kStiffness : kTurnStiffness));
}

bool Joints::set(size_t i, const JointProperties& properties) noexcept {
    if (joints_[i].properties == properties) return false;
    joints_[i].properties = properties;
    return true;
}

void Joints::drive(size_t i, const Motor& motor) noexcept {
    joints_[i].motor = motor;
}

std::pair<Vec6, Vec6> Joints::along(size_t i) const noexcept {
    const Joint& joint = joints_[i];
    std::array<ProblemJoint, kElements> rows;
    fill(joint, pose_of(joint.a), pose_of(joint.b), rows);
    return {rows[2].J_a.row(0), rows[2].J_b.row(0)};
}

double Joints::ask(size_t i, double h, const Vec6& v_a, const Vec6& v_b) noexcept {
    Joint& joint = joints_[i];
    const double q_near = states_[i].position;
    const Gaps then = gaps(joint, moved(joint.a, v_a, h), moved(joint.b, v_b, h), q_near);
    if (joint.spec.row().yields) {
        // this suffices: an error in the guess affects a spring only in proportion to the square of
        // the rotation in a step
        ask_of_bushing(joint, then, h, v_a, v_b, joint.rows);
        return 0;
    }
    double most = 0;
    const Gaps now = gaps(joint, pose_of(joint.a), pose_of(joint.b), q_near);
    for (int k = 0; k < 3; ++k) {
        const auto set = [&](ProblemJoint& row, double gap, double gap_then, double stiffness,
                             double most_pull) {
            if (row.low[k] == row.high[k]) return;
            row.compliance[k] = 1 / (h * h * stiffness);
            const double pull = std::clamp(gap / h, -most_pull, most_pull);
            const double bias = pull + (gap_then - gap) / h - inside(row, k, v_a, v_b);
            most = std::max(most, std::abs(bias - row.bias[k]));
            row.bias[k] = bias;
        };
        set(joint.rows[0], now.linear[k], then.linear[k], kStiffness, kPull);
        set(joint.rows[1], now.angular[k], then.angular[k], kTurnStiffness, kTurnPull);
    }
    if (joint.spec.has_coordinate())
        most = std::max(most, ask_of_coordinate(i, then.q - h * inside(joint.rows[2], 0, v_a, v_b),
                                                now.q, h, joint.rows[2]));
    return most;
}

void Joints::tell(const Joint& joint, contact::ContactProblem& problem) noexcept {
    for (size_t e = 0; e < kElements; ++e) {
        if (joint.row_at[e] >= 0)
            problem.joints[static_cast<size_t>(joint.row_at[e])] = joint.rows[e];
    }
}

/// A guess of a body's velocities after the step. Velocity changes are assumed to continue as in
/// the last steps, unless the body turns so far in a step that the forces on it change direction.
Vec6 Joints::expected(const Side& side, const Change& change, double h) noexcept {
    constexpr double kFar = 0.1;  // [rad]
    const Vec6 v = velocity_of(side);
    return h * v.tail<3>().norm() > kFar ? v : Vec6(v + change.next());
}

void Joints::add_rows(std::span<const size_t> which, std::span<const int> index, double h,
                      contact::ContactProblem& problem, std::vector<Vec3>& start) noexcept {
    // discard a little of the load shared by redundant joints in each step
    constexpr double kKept = 0.95;
    for (const size_t i : which) {
        Joint& joint = joints_[i];
        for (ProblemJoint& rows : joint.rows) {
            rows = {};
            rows.a = joint.a.fixed ? contact::kFixed : index[joint.a.at()];
            rows.b = joint.b.fixed ? contact::kFixed : index[joint.b.at()];
        }
        fill(joint, pose_of(joint.a), pose_of(joint.b), joint.rows);
        joint.start = gaps(joint, pose_of(joint.a), pose_of(joint.b), states_[i].position);
        joint.acts_at_W = pose_of(joint.b) * joint.X_BF.p;
        if (joint.spec.has_axis_spring() || joint.motor)
            joint.inverse_mass = along_coordinate(problem, joint.rows);
        if (joint.spec.row().yields) joint.inverse_masses = along_rows(problem, joint.rows);
        ask(i, h, expected(joint.a, joint.change_a, h), expected(joint.b, joint.change_b, h));
        for (size_t e = 0; e < kElements; ++e) {
            const ProblemJoint& rows = joint.rows[e];
            joint.row_at[e] = -1;
            if (rows.low.isZero(0) && rows.high.isZero(0)) continue;
            joint.row_at[e] = static_cast<int>(problem.joints.size());
            problem.joints.push_back(rows);
            start.push_back(kKept * joint.impulses[e]);
        }
    }
}

double Joints::guess(std::span<const size_t> which, std::span<const int> index, double h,
                     std::span<const Vec6> change, contact::ContactProblem& problem) noexcept {
    double most = 0;
    for (const size_t i : which) {
        const Joint& joint = joints_[i];
        const auto then = [&](const Side& side) -> Vec6 {
            if (side.fixed) return Vec6::Zero();
            return velocity_of(side) + change[static_cast<size_t>(index[side.at()])];
        };
        most = std::max(most, ask(i, h, then(joint.a), then(joint.b)));
        tell(joint, problem);
    }
    return most;
}

void Joints::hold(std::span<const size_t> which, double h,
                  contact::ContactProblem& problem) noexcept {
    for (const size_t i : which) {
        ask(i, h, Vec6::Zero(), Vec6::Zero());
        tell(joints_[i], problem);
    }
}

void Joints::store(std::span<const size_t> which, std::span<const int> index,
                   std::span<const Vec6> change, std::span<const Vec3> impulses,
                   double h) noexcept {
    const auto change_of = [&](const Side& side) -> Vec6 {
        if (side.fixed) return Vec6::Zero();
        return change[static_cast<size_t>(index[side.at()])];
    };
    for (const size_t i : which) {
        Joint& joint = joints_[i];
        joint.change_a.now = change_of(joint.a);
        joint.change_b.now = change_of(joint.b);
        for (size_t e = 0; e < kElements; ++e) {
            const int at = joint.row_at[e];
            joint.impulses[e] = at < 0 ? Vec3(Vec3::Zero()) : impulses[static_cast<size_t>(at)];
        }
        const Pose X_WF = pose_of(joint.a) * joint.X_AF;
        const Mat3 F = X_WF.R.toRotationMatrix();
        JointState& state = states_[i];
        state.force_W = F * joint.impulses[0] / h;
        const double along = joint.impulses[2].sum() / h;
        state.torque_W = Vec3::Zero();
        if (joint.spec.is_distance()) {
            state.force_W = along * direction(joint, pose_of(joint.a), pose_of(joint.b));
        } else if (joint.spec.slides()) {
            state.force_W += along * F.col(0);
        } else {
            state.torque_W = along * F.col(0);
        }
        const Mat3 G = (pose_of(joint.b) * joint.X_BF).R.toRotationMatrix();
        for (int k = 0; k < 3; ++k) {
            const double moment = joint.impulses[1][k] / h;
            state.torque_W += moment * turning_direction(joint.spec.row().turning, F, G, k);
        }
    }
}

void Joints::end_step() noexcept {
    for (Joint& joint : joints_) {
        joint.change_a.end_step();
        joint.change_b.end_step();
        joint.led_from = joint.motor ? joint.motor->position : std::nullopt;
        joint.motor.reset();
    }
}

void Joints::read() noexcept {
    for (size_t i = 0; i < joints_.size(); ++i) {
        Joint& joint = joints_[i];
        JointState& state = states_[i];
        const Pose X_WA = pose_of(joint.a);
        const Pose X_WB = pose_of(joint.b);
        if (!joint.spec.has_coordinate() && !joint.spec.row().yields) continue;
        std::array<ProblemJoint, kElements> rows;
        fill(joint, X_WA, X_WB, rows);
        const Vec6 v_a = velocity_of(joint.a);
        const Vec6 v_b = velocity_of(joint.b);
        if (joint.spec.row().yields) {
            for (int k = 0; k < 6; ++k)
                joint.rates[k] = inside(rows[static_cast<size_t>(k / 3)], k % 3, v_a, v_b);
            continue;
        }
        state.position = gaps(joint, X_WA, X_WB, state.position).q;
        state.velocity = inside(rows[2], 0, v_a, v_b);
    }
}

void Joints::forget() noexcept {
    end_step();
    for (Joint& joint : joints_) {
        joint.impulses.fill(Vec3::Zero());
        joint.change_a = joint.change_b = {};
    }
}

}  // namespace dihaptic::dynamics
