#include "dynamics/books.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::dynamics {
namespace {

/// Rounding can explain a momentum error of up to this fraction of the summed impulses.
constexpr double kRounding = 1e-6;
constexpr double kLeastMomentum = 1e-9;  // [N*s]
constexpr double kLeastTurning = 1e-11;  // [N*m*s]
/// Time window over which unexplained energy is summed, and compared with the energy present and
/// exchanged [s].
constexpr double kMemory = 0.5;
constexpr double kMostShare = 0.03;
constexpr double kLeastEnergy = 5e-4;  // [J]

Vec3 angular_momentum(const Books::Body& body, const Mat3& R_WM, const Vec3& w_W) {
    return R_WM * Vec3(body.moments.cwiseProduct(R_WM.transpose() * w_W));
}

/// Returns the angular velocity of a freely turning body, given its angular momentum.
Vec3 turning_by(const Vec3& L_W, const Books::Body& body, const Mat3& R_WM) {
    return R_WM * Vec3(Vec3(R_WM.transpose() * L_W).cwiseQuotient(body.moments));
}

double kinetic_of(const Books::Body& body, const Vec3& v_W, const Vec3& w_W, const Vec3& L_W) {
    return (v_W.dot(body.masses.cwiseProduct(v_W)) + w_W.dot(L_W)) / 2;
}

double potential_of(const Books::Body& body, const Books::Motion& at, double h) {
    return -body.weight_W.dot(at.p_WM - h / 2 * at.v_W);
}

}  // namespace

void Books::reserve(size_t bodies, size_t joints) {
    entries_.assign(bodies, {});
    owed_.assign(joints, 0);
    open_.reserve(bodies);
}

void Books::forget() noexcept {
    for (Entry& one : entries_) one.open = false;
    open_.clear();
    std::fill(owed_.begin(), owed_.end(), 0);
    has_last_ = false;
    found_ = exchanged_ = owed_by_contacts_ = 0;
    balance_ = {};
}

void Books::begin(double h) noexcept {
    for (const size_t i : open_) entries_[i].open = false;
    open_.clear();
    h_ = h;
    before_ = last_energy_ = gains_ = by_contacts_ = 0;
    last_springs_ = springs_;
    springs_ = 0;
    balance_ = {};
}

void Books::open(size_t body, const Body& what, const Motion& before, const Wrench& load_W,
                 bool late) noexcept {
    Entry& one = entries_[body];
    last_energy_ += one.kinetic + one.potential;
    one.open = true;
    one.late = late;
    one.body = what;
    one.before = before;
    one.load_W = late ? Wrench{} : load_W;
    one.L_before_W = angular_momentum(what, before.R_WM, before.w_W);
    one.impulse_W.setZero();
    one.moment_W.setZero();
    one.size = one.turning_size = 0;
    open_.push_back(body);
    if (what.is_outside) return;
    before_ +=
        kinetic_of(what, before.v_W, before.w_W, one.L_before_W) + potential_of(what, before, h_);
}

void Books::close(size_t body, const Motion& after, bool bounced) noexcept {
    Entry& one = entries_[body];
    if (!one.open) return;
    one.after = after;
    if (one.body.is_led) {
        one.before.v_W = after.v_W;
        one.before.w_W = after.w_W;
    }
    one.bounced = bounced;
    one.L_after_W = angular_momentum(one.body, after.R_WM, after.w_W);
    const bool free = one.body.turns == Vec3::Ones() && one.body.moments.minCoeff() > 0;
    one.w_struck_W = free && !one.body.is_outside
                         ? turning_by(one.L_after_W, one.body, one.before.R_WM)
                         : after.w_W;
    one.v_mean_W = (one.before.v_W + after.v_W) / 2;
    one.w_mean_W = (one.before.w_W + one.w_struck_W) / 2;
}

const Books::Entry* Books::entry(int body) const noexcept {
    if (body < 0 || !entries_[static_cast<size_t>(body)].open) return nullptr;
    return &entries_[static_cast<size_t>(body)];
}

Books::Meeting Books::meet(const Exchange& exchange) const noexcept {
    Meeting out;
    const auto add = [&](const Entry* one, const Vec3& p_W, double sign) {
        if (one == nullptr) return;
        const Vec3 arm = p_W - one->before.p_WM;
        out.v_mean += sign * (one->v_mean_W + one->w_mean_W.cross(arm));
        out.v_after += sign * (one->after.v_W + one->w_struck_W.cross(arm));
        out.w_mean += sign * one->w_mean_W;
        out.w_after += sign * one->w_struck_W;
    };
    add(entry(exchange.a), exchange.point_of_a(), -1);
    add(entry(exchange.b), exchange.point_of_b(), 1);
    return out;
}

Vec3 Books::way(const Exchange& exchange) const noexcept {
    const auto of = [&](const Entry* one, const Vec3& p_W) -> Vec3 {
        if (one == nullptr) return Vec3::Zero();
        const Vec3 arm = one->before.R_WM.transpose() * (p_W - one->before.p_WM);
        return one->after.p_WM + one->after.R_WM * arm - p_W;
    };
    return of(entry(exchange.b), exchange.point_of_b()) -
           of(entry(exchange.a), exchange.point_of_a());
}

void Books::check_gap(const Exchange& exchange, const Meeting& meeting, const Vec3& n_W,
                      double gap) noexcept {
    constexpr double kLeast = 1e-4;      // [m]
    constexpr double kShareOfWay = 0.1;  // margin, since surfaces are curved and turn
    const auto enters = [&](const Vec3& way) {
        const double inside = -std::max(gap, 0.0) - way.dot(n_W);
        return inside > kLeast && inside > kLeast + kShareOfWay * way.norm();
    };
    // a fault only if both the velocities and the paths clearly show that a body enters the other
    if (enters(h_ * meeting.v_after) && enters(way(exchange))) balance_.unbalanced = true;
}

void Books::act(Entry& one, const Vec3& p_W, const Vec3& impulse_W, const Vec3& moment_W) noexcept {
    const Vec3 arm = p_W - one.before.p_WM;
    one.impulse_W += impulse_W;
    one.moment_W += arm.cross(impulse_W) + moment_W;
    const double size = impulse_W.lpNorm<1>();
    one.size += size;
    one.turning_size += arm.lpNorm<1>() * size + moment_W.lpNorm<1>();
}

void Books::take(const Exchange& exchange, const Meeting& meeting) noexcept {
    before_ += exchange.stored_before;
    springs_ += exchange.stored_after;
    double outside = 0;  // work done on the free body by the led body
    bool within = false;
    for (const double sign : {-1.0, 1.0}) {
        const int body = sign < 0 ? exchange.a : exchange.b;
        if (entry(body) == nullptr) continue;
        Entry& one = entries_[static_cast<size_t>(body)];
        const Vec3 p_W = sign < 0 ? exchange.point_of_a() : exchange.point_of_b();
        act(one, p_W, sign * exchange.impulse_W, sign * exchange.moment_W);
        within = within || !one.body.is_outside;
        if (!one.body.is_outside) continue;
        const Vec3 v = one.v_mean_W + one.w_mean_W.cross(p_W - one.before.p_WM);
        outside -= sign * (exchange.impulse_W.dot(v) + exchange.moment_W.dot(one.w_mean_W));
    }
    if (!within) return;
    const double work =
        exchange.impulse_W.dot(meeting.v_mean) + exchange.moment_W.dot(meeting.w_mean);
    // energy released by the exchange, including its springs
    const double passive = work - exchange.given + exchange.stored_after - exchange.stored_before;
    if (exchange.joint < 0) {
        by_contacts_ += passive;
        gains_ += exchange.found;
        balance_.dissipated += exchange.found - passive;
    } else {
        const double found = owe(owed_[static_cast<size_t>(exchange.joint)], passive);
        gains_ += found;
        balance_.dissipated += found - passive;
    }
    balance_.work += outside + exchange.given;
    exchanged_ += std::abs(outside + exchange.given) + std::abs(passive);
}

double Books::owe(double& owed, double passive) noexcept {
    const double before = std::max(0.0, owed);
    owed += passive;
    return std::max(0.0, owed) - before;
}

void Books::check_momentum(const Entry& one) noexcept {
    const Body& body = one.body;
    const Vec3 change = body.masses.cwiseProduct(one.after.v_W - one.before.v_W);
    const Vec3 load = h_ * (one.load_W.force + (one.late ? Vec3(Vec3::Zero()) : body.weight_W));
    // check that the change in position follows from the velocity
    const Vec3 moved = body.masses.cwiseProduct((one.after.p_WM - one.before.p_WM) / h_);
    const Vec3 leads = body.masses.cwiseProduct(one.after.v_W);
    const double off = (change - load - one.impulse_W).cwiseProduct(body.moves).norm();
    const double lost = one.bounced ? 0 : (moved - leads).norm();
    const double size = leads.norm() + change.norm() + load.norm() + one.size +
                        (body.masses.cwiseProduct(one.after.p_WM) / h_).norm() * 1e-6;
    balance_.momentum_imbalance = std::max({balance_.momentum_imbalance, off, lost});
    if (std::max(off, lost) > kRounding * size + kLeastMomentum) balance_.unbalanced = true;

    if (!one.bounced && !body.is_outside) check_turn(one);
    // if a body has two free axes, its guides exert moments about all axes
    if (body.turns.sum() == 0 || body.turns.sum() == 2) return;
    const Vec3 torque = h_ * one.load_W.torque;
    const double turning =
        (one.L_after_W - one.L_before_W - torque - one.moment_W).cwiseProduct(body.turns).norm();
    const double turning_size =
        one.L_after_W.norm() + one.L_before_W.norm() + torque.norm() + one.turning_size;
    balance_.angular_imbalance = std::max(balance_.angular_imbalance, turning);
    if (turning > kRounding * turning_size + kLeastTurning) balance_.unbalanced = true;
}

void Books::check_turn(const Entry& one) noexcept {
    // the trapezoidal rule gives the mean velocity with an error of second order in the angle
    const Vec3 mean = (one.w_struck_W + one.after.w_W) / 2;
    const Mat3 R = one.after.R_WM * one.before.R_WM.transpose();
    const Vec3 sine = Vec3(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1)) / 2;
    const double size = sine.norm();  // valid for an angle below 90 degrees
    const Vec3 turned = (size > 1e-6 ? std::asin(std::min(1.0, size)) / size : 1) * sine / h_;
    const double off = (turned - mean).norm();
    const double speed = mean.norm();
    // iterations of free rotation stop when successive guesses differ by about this much
    constexpr double kLeast = 1e-4;  // [rad/s]
    if (off <= kLeast * (1 + speed) + speed * h_ * speed * h_ * speed) return;
    balance_.unbalanced = true;
    balance_.angular_imbalance =
        std::max(balance_.angular_imbalance, one.body.moments.maxCoeff() * off);
}

void Books::count_energy(Entry& one) noexcept {
    one.kinetic = one.potential = 0;
    const Body& body = one.body;
    if (body.is_outside) return;
    one.kinetic = kinetic_of(body, one.after.v_W, one.after.w_W, one.L_after_W);
    one.potential = potential_of(body, one.after, h_);
    const double by_load =
        h_ * (one.load_W.force.dot(one.v_mean_W) + one.load_W.torque.dot(one.w_mean_W));
    const double by_weight = h_ * body.weight_W.dot(one.v_mean_W);
    exchanged_ += std::abs(by_load) + std::abs(by_weight);
    balance_.work += by_load;
    if (one.late) balance_.work -= by_weight;
    // the time of the impact within the step is unknown
    if (one.bounced)
        balance_.dissipated -= one.potential - potential_of(body, one.before, h_) + by_weight;
}

void Books::balance() noexcept {
    for (const size_t i : open_) {
        if (!entries_[i].body.is_led) check_momentum(entries_[i]);
        count_energy(entries_[i]);
    }
    // a contact may take energy that another gives within the step, but their sum must not give any
    const double found = owe(owed_by_contacts_, by_contacts_);
    gains_ += found;
    balance_.dissipated += found;
    double after = springs_;
    for (const size_t i : open_) after += entries_[i].kinetic + entries_[i].potential;
    balance_.energy_imbalance = after - before_ - balance_.work + balance_.dissipated;
    if (has_last_) balance_.work += before_ - last_energy_ - last_springs_;
    has_last_ = true;
    balance_.potential = springs_;
    for (const Entry& one : entries_) {
        balance_.kinetic += one.kinetic;
        balance_.potential += one.potential;
    }
    judge();
}

void Books::judge() noexcept {
    const double kept = std::exp(-h_ / kMemory);
    const double residual = std::abs(balance_.energy_imbalance - gains_);
    found_ = std::max(0.0, kept * found_ + gains_ + residual);
    const double there = balance_.kinetic + exchanged_;
    if (found_ > kMostShare * there + kLeastEnergy) balance_.unbalanced = true;
    exchanged_ *= kept;
    for (double& owed : owed_) owed *= kept;
    owed_by_contacts_ *= kept;
}

void Books::rest(size_t body) noexcept {
    balance_.kinetic -= entries_[body].kinetic;
    balance_.dissipated += entries_[body].kinetic;
    entries_[body].kinetic = 0;
}

}  // namespace dihaptic::dynamics
