#include "view/hand_bones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace dihaptic::view {
namespace {

using Lengths = std::array<double, 3>;

// Lengths of the bones of a hand that is 19 cm long [m].
constexpr Lengths kThumb{0.045, 0.033, 0.028};
constexpr Lengths kIndex{0.043, 0.026, 0.022};
constexpr double kPad = 0.006;  // distance of the bone's end below the skin [m]

/// The hand's axes: a from the thumb to the index finger, f to the wrist, n out of the palm.
struct Axes {
    Vec3 a, f, n;

    Vec3 at(const Vec3& origin, double along_a, double along_f, double along_n) const {
        return origin + along_a * a + along_f * f + along_n * n;
    }
};

Axes axes(const Vec3& thumb, const Vec3& index) {
    Axes out;
    out.a = (index - thumb).normalized();
    const Vec3 person(0, -0.85, 0.53), above(0, 0.3, 0.95);
    // if the grip axis is along the forearm, the hand comes from above
    const Vec3& toward = std::abs(out.a.dot(person)) < 0.9 ? person : above;
    out.f = (toward - toward.dot(out.a) * out.a).normalized();
    out.n = out.a.cross(out.f);
    return out;
}

/// The joints of a finger that is bent by the same angle at every joint. It lies in the plane of
/// `root`, `tip` and `bulge`, and bulges toward `bulge`.
std::array<Vec3, 4> finger(const Vec3& root, const Vec3& tip, const Lengths& lengths,
                           const Vec3& bulge) {
    using Plane = std::complex<double>;
    const auto joints = [&](double bend) {
        std::array<Plane, 4> out{};
        for (size_t i = 0; i < 3; ++i)
            out[i + 1] = out[i] + std::polar(lengths[i], bend * static_cast<double>(i));
        return out;
    };
    const double distance = (tip - root).norm();
    double straight = 0, bent = 2.2;  // [rad]
    for (int i = 0; i < 40; ++i) {
        const double middle = (straight + bent) / 2;
        (std::abs(joints(middle)[3]) > distance ? straight : bent) = middle;
    }
    const std::array<Plane, 4> flat = joints(straight);
    const Vec3 u = (tip - root).normalized();
    const Vec3 w = (bulge - bulge.dot(u) * u).normalized();
    const Plane turn = std::conj(flat[3]) / std::abs(flat[3]);
    std::array<Vec3, 4> out;
    for (size_t i = 0; i < out.size(); ++i) {
        const Plane p = flat[i] * turn;
        out[i] = root + p.real() * u - p.imag() * w;
    }
    return out;
}

void add(std::vector<Bone>& out, const std::array<Vec3, 4>& joints, double radius) {
    for (size_t i = 0; i < 3; ++i)
        out.push_back({joints[i], joints[i + 1], radius * (1 - 0.07 * static_cast<double>(i))});
}

/// Distance from the grip to the palm along f, chosen so that both fingers reach the grip and, if
/// there is room, are bent.
double distance_of_palm(double half_opening) {
    const auto within = [](double length, double across) {
        return std::sqrt(std::max(0.0, length * length - across * across));
    };
    constexpr double kBent = 0.07, kLeast = 0.015, kShare = 0.97;
    const double index = kShare * (kIndex[0] + kIndex[1] + kIndex[2]);
    const double thumb = kShare * (kThumb[0] + kThumb[1] + kThumb[2]);
    return std::max(kLeast, std::min({kBent, within(index, half_opening - 0.022),
                                      within(thumb, half_opening - 0.008) - 0.025}));
}

}  // namespace

std::vector<Bone> hand_bones(const Vec3& thumb, const Vec3& index) {
    const double opening = (index - thumb).norm();
    if (!(opening > 1e-3) || !std::isfinite(opening)) return {};
    const Axes axes = view::axes(thumb, index);
    const Vec3 thumb_tip = thumb - kPad * axes.a, index_tip = index + kPad * axes.a;
    const Vec3 palm = axes.at((thumb + index) / 2, 0, distance_of_palm(opening / 2 + kPad), 0);
    const Vec3 wrist = axes.at(palm, 0.03, 0.075, 0.004);

    std::vector<Bone> out{{wrist, axes.at(wrist, 0.008, 0.07, 0), 0.021}};
    const Vec3 thumb_root = axes.at(palm, -0.008, 0.025, 0.008);
    out.push_back({thumb_root, wrist, 0.015});
    add(out, finger(thumb_root, thumb_tip, kThumb, -axes.a - 0.3 * axes.n), 0.0095);

    struct Other {
        double root_a, root_f, tip_a,
            tip_f;  // root: offset from the palm; tip: offset from the index finger's tip [m]
        Lengths lengths;
        double radius;
    };
    const std::array others{
        Other{0.022, 0, 0, 0, kIndex, 0.0082},
        Other{0.041, 0.001, 0.017, 0.006, {0.046, 0.029, 0.023}, 0.0084},
        Other{0.059, 0.006, 0.033, 0.015, {0.043, 0.027, 0.022}, 0.0078},
        Other{0.075, 0.014, 0.047, 0.026, {0.034, 0.020, 0.018}, 0.0068},
    };
    for (const Other& other : others) {
        const Vec3 root = axes.at(palm, other.root_a, other.root_f, -0.012);
        const Vec3 tip = axes.at(index_tip, other.tip_a, other.tip_f, 0);
        out.push_back({root, wrist, 0.0125});
        add(out, finger(root, tip, other.lengths, axes.a - axes.n), other.radius);
    }
    return out;
}

}  // namespace dihaptic::view
