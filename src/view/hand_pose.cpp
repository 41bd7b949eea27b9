#include "view/hand_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace dihaptic::view {
namespace {

using Lengths = std::array<double, 3>;

/// A finger of a hand that is 19 cm long.
struct Anatomy {
    Vec3 root;            // in the palm's frame [m]
    Lengths lengths;      // of its bones [m]
    Vec3 straight;        // direction of the straight finger of an open hand, in the palm's frame
    double tip_a, tip_f;  // offset of its tip from that of the index finger [m]; 0 for the thumb
};

const std::array<Anatomy, 5> kFingers{
    Anatomy{{-0.008, 0.025, 0.008}, {0.045, 0.033, 0.028}, {-0.75, -0.6, 0.3}, 0, 0},
    Anatomy{{0.022, 0, -0.012}, {0.043, 0.026, 0.022}, {-0.17, -1, 0}, 0, 0},
    Anatomy{{0.041, 0.001, -0.012}, {0.046, 0.029, 0.023}, {0, -1, 0}, 0.017, 0.006},
    Anatomy{{0.059, 0.006, -0.012}, {0.043, 0.027, 0.022}, {0.17, -1, 0}, 0.033, 0.015},
    Anatomy{{0.075, 0.014, -0.012}, {0.034, 0.020, 0.018}, {0.36, -1, 0}, 0.047, 0.026},
};

double length(const Anatomy& finger) {
    return finger.lengths[0] + finger.lengths[1] + finger.lengths[2];
}

/// The direction in which a finger bulges: `bulge`, made perpendicular to the finger.
Vec3 back_of(const Vec3& from, const Vec3& to, const Vec3& bulge) {
    const Vec3 u = (to - from).normalized();
    return (bulge - bulge.dot(u) * u).normalized();
}

// where thumb and fingers bulge, in the palm's frame
const Vec3 kThumbBack(-1, 0, -0.3), kFingerBack(1, 0, -1);

/// The palm's axes for a grip along `grip`.
Quat palm_axes(const Vec3& grip) {
    const Vec3 a = grip.normalized();
    const Vec3 person(0, -0.85, 0.53), above(0, 0.3, 0.95);
    // if the grip axis is along the forearm, the hand comes from above
    const Vec3& toward = std::abs(a.dot(person)) < 0.9 ? person : above;
    const Vec3 f = (toward - toward.dot(a) * a).normalized();
    Mat3 R;
    R << a, f, a.cross(f);
    return Quat(R);
}

/// A finger that is bent by the same angle at every joint. It lies in the plane of `root`, `tip`
/// and `bulge`, and bulges toward `bulge`.
HandPose::Finger bent(const Vec3& root, const Vec3& tip, const Lengths& lengths,
                      const Vec3& bulge) {
    using Plane = std::complex<double>;
    const auto joints = [&](double bend) {
        std::array<Plane, 4> out{};
        for (size_t i = 0; i < 3; ++i)
            out[i + 1] = out[i] + std::polar(lengths[i], bend * static_cast<double>(i));
        return out;
    };
    const double distance = (tip - root).norm();
    double straight = 0, folded = 2.2;  // [rad]
    for (int i = 0; i < 40; ++i) {
        const double middle = (straight + folded) / 2;
        (std::abs(joints(middle)[3]) > distance ? straight : folded) = middle;
    }
    const std::array<Plane, 4> flat = joints(straight);
    const Vec3 u = (tip - root).normalized();
    const Plane turn = std::conj(flat[3]) / std::abs(flat[3]);
    HandPose::Finger out;
    out.back = back_of(root, tip, bulge);
    for (size_t i = 0; i < out.joints.size(); ++i) {
        const Plane p = flat[i] * turn;
        out.joints[i] = root + p.real() * u - p.imag() * out.back;
    }
    return out;
}

/// Distance from the grip to the palm along f, chosen so that both fingers reach the grip and, if
/// there is room, are bent.
double distance_of_palm(double half_opening) {
    const auto within = [](double length, double across) {
        return std::sqrt(std::max(0.0, length * length - across * across));
    };
    constexpr double kBent = 0.07, kLeast = 0.015, kShare = 0.97;
    const double thumb = kShare * length(kFingers[0]);
    const double index = kShare * length(kFingers[1]);
    return std::max(kLeast, std::min({kBent, within(index, half_opening - 0.022),
                                      within(thumb, half_opening - 0.008) - 0.025}));
}

}  // namespace

const HandPose& open_hand() {
    static const HandPose hand = [] {
        HandPose out;
        for (size_t i = 0; i < kFingers.size(); ++i) {
            const Anatomy& is = kFingers[i];
            const Vec3 tip = is.root + length(is) * is.straight.normalized();
            out.fingers[i] = bent(is.root, tip, is.lengths, i == 0 ? kThumbBack : kFingerBack);
        }
        return out;
    }();
    return hand;
}

std::optional<HandPose> hand_pose(const Vec3& thumb, const Vec3& index) {
    const double opening = (index - thumb).norm();
    if (!(opening > 1e-3) || !std::isfinite(opening)) return std::nullopt;
    HandPose out;
    out.palm.R = palm_axes(index - thumb);
    const Vec3 a = out.palm.R * Vec3::UnitX(), f = out.palm.R * Vec3::UnitY();
    out.palm.p = (thumb + index) / 2 + distance_of_palm(opening / 2 + kPad) * f;
    for (size_t i = 0; i < kFingers.size(); ++i) {
        const Anatomy& is = kFingers[i];
        const Vec3 tip =
            i == 0 ? Vec3(thumb - kPad * a) : Vec3(index + (kPad + is.tip_a) * a + is.tip_f * f);
        out.fingers[i] = bent(out.palm * is.root, tip, is.lengths,
                              out.palm.R * (i == 0 ? kThumbBack : kFingerBack));
    }
    return out;
}

}  // namespace dihaptic::view
