#include "session/mass_checks.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/solid.h"

namespace dihaptic::session {
namespace {

/// Largest mass ratio in a stack that a solver can handle (src/dynamics/README.md).
double most_ratio(contact::Solver solver) {
    switch (solver) {
        case contact::Solver::sequential_impulse:
            return 300;
        case contact::Solver::stewart_trinkle:
            return 1e4;
        case contact::Solver::newton:
            return 1e5;
        case contact::Solver::staggered_projections:
            break;
    }
    return 1e6;
}

bool moves(const scene::Body& body) {
    return !body.fixed && !body.driven;
}

void check_ratio(const Plan& plan, Diagnostics& diagnostics) {
    const scene::Body* heavy = nullptr;
    const scene::Body* light = nullptr;
    for (const scene::Body& body : plan.scene.bodies) {
        if (!moves(body)) continue;
        if (heavy == nullptr || scene::mass(body) > scene::mass(*heavy)) heavy = &body;
        if (light == nullptr || scene::mass(body) < scene::mass(*light)) light = &body;
    }
    if (heavy == nullptr) return;
    const contact::Solver solver = plan.settings.dynamics.solver;
    const double ratio = scene::mass(*heavy) / scene::mass(*light);
    if (ratio <= most_ratio(solver)) return;
    const bool other = ratio <= most_ratio(contact::Solver::staggered_projections);
    diagnostics.warning(
        heavy->place, heavy->name,
        fmt::format("has {:.3g} times the mass of {}: above {:g} times, the solver {} may let "
                    "the heavier body push the lighter one aside, or through its support",
                    ratio, light->name, most_ratio(solver), enum_name(solver)),
        other ? "Choose the solver staggered_projections, or make their masses more alike."
              : "Make their masses more alike.");
}

/// Bodies and their joints, as trees suspended from immovable bodies.
class Mechanisms {
  public:
    explicit Mechanisms(const scene::Scene& scene) : scene_(scene) {
        const size_t count = scene.bodies.size();
        links_.resize(count);
        std::vector<size_t> order;
        for (size_t at = 0; order.size() < count;) {
            if (at == order.size()) {  // start another mechanism from its fixed joint
                if (!hang_next(order)) break;
                continue;
            }
            hang_on(order[at++], order);
        }
        for (auto i = order.rbegin(); i != order.rend(); ++i) {
            Link& link = links_[*i];
            link.carries += scene::mass(scene.bodies[*i]);
            if (link.above) links_[*link.above].carries += link.carries;
        }
    }

    /// How fast a suspended load turns a link: `rate` is sqrt(T l / I), where T is the tension and
    /// l is the distance between the link's joints.
    struct Turned {
        double rate = 0;     // [rad/s]
        double tension = 0;  // [N]
    };
    Turned turned(size_t i) const {
        const Link& link = links_[i];
        if (!link.hangs_at || !link.carries_at) return {};
        const scene::Body& body = scene_.bodies[i];
        const scene::Solid solid = scene::solid_of(body.shape, scene::mass(body));
        const Vec3 along = *link.carries_at - *link.hangs_at;
        const double length = along.norm();
        if (!(length > 0)) return {};
        const Mat3 R = (body.pose() * solid.X_BM).R.toRotationMatrix();
        const Mat3 I = R * solid.inertia.asDiagonal() * R.transpose();
        const Vec3 across = along.unitOrthogonal();
        const Vec3 other = along.normalized().cross(across);
        Eigen::Matrix2d of_turns;
        of_turns << across.dot(I * across), across.dot(I * other), across.dot(I * other),
            other.dot(I * other);
        const double least =
            Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(of_turns).eigenvalues()[0];
        const double tension = link.carries * scene_.gravity.norm();
        return {std::sqrt(tension * length / least), tension};
    }

  private:
    struct Link {
        bool hung = false;
        std::optional<size_t> above;
        std::optional<Vec3> hangs_at;    // position in the world [m]
        std::optional<Vec3> carries_at;  // position of the joint that carries the heaviest load [m]
        double carries = 0;              // carried mass, including the link's own mass [kg]
    };

    /// Returns the body's index, or nullopt for an immovable body.
    std::optional<size_t> moving(const std::string& name) const {
        const auto i = static_cast<size_t>(scene_.find(name));
        if (i >= scene_.bodies.size() || !moves(scene_.bodies[i])) return std::nullopt;
        return i;
    }
    void hang(size_t i, const Vec3& at, std::optional<size_t> above, std::vector<size_t>& order) {
        if (links_[i].hung) return;
        links_[i].hung = true;
        links_[i].above = above;
        links_[i].hangs_at = at;
        if (above) links_[*above].carries_at = at;
        order.push_back(i);
    }
    bool hang_next(std::vector<size_t>& order) {
        const size_t before = order.size();
        for (const scene::Joint& joint : scene_.joints) {
            const auto last = moving(joint.between.back());
            const auto first =
                joint.between.size() == 2 ? moving(joint.between.front()) : std::nullopt;
            if (first && last) continue;
            if (first) hang(*first, joint.position, {}, order);
            if (last) hang(*last, joint.second_position.value_or(joint.position), {}, order);
            if (order.size() > before) return true;
        }
        return false;
    }
    void hang_on(size_t i, std::vector<size_t>& order) {
        for (const scene::Joint& joint : scene_.joints) {
            if (joint.between.size() != 2) continue;
            const auto first = moving(joint.between.front());
            const auto last = moving(joint.between.back());
            if (!first || !last) continue;
            if (*first == i) hang(*last, joint.position, i, order);
            if (*last == i) hang(*first, joint.position, i, order);
        }
    }

    const scene::Scene& scene_;
    std::vector<Link> links_;
};

void check_links(const Plan& plan, Diagnostics& diagnostics) {
    if (plan.scene.joints.empty()) return;
    const Mechanisms mechanisms(plan.scene);
    const double step = plan.settings.dynamics.every / plan.settings.rate;
    const double most = 2 / step;
    size_t fastest = 0;
    Mechanisms::Turned worst;
    for (size_t i = 0; i < plan.scene.bodies.size(); ++i) {
        const Mechanisms::Turned turned = mechanisms.turned(i);
        if (turned.rate <= worst.rate) continue;
        worst = turned;
        fastest = i;
    }
    if (worst.rate <= most) return;
    const scene::Body& body = plan.scene.bodies[fastest];
    diagnostics.warning(
        body.place, body.name,
        fmt::format("is so light that the suspended load of {:.3g} N turns it at {:.0f} rad/s: "
                    "above {:.0f} rad/s (2 / step) its joints come apart",
                    worst.tension, worst.rate, most),
        fmt::format("Make it {:.0f} times as heavy, or settings: rate_Hz: {:.0f} or more, or "
                    "reduce the load on it.",
                    std::ceil(std::pow(worst.rate / most, 2)),
                    std::ceil(plan.settings.rate * worst.rate / most / 100) * 100));
}

}  // namespace

void check_masses(const Plan& plan, Diagnostics& diagnostics) {
    check_ratio(plan, diagnostics);
    check_links(plan, diagnostics);
}

}  // namespace dihaptic::session
