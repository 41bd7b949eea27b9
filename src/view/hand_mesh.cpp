#include "view/hand_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "view/isosurface.h"

namespace dihaptic::view {
namespace {

/// A part of the hand: a rod with round ends that may be thicker at one end [m].
struct Flesh {
    Vec3 from, to;
    double from_radius, to_radius;

    /// Distance from its surface, negative inside; exact if both ends are equally thick.
    double operator()(const Vec3& p) const {
        const Vec3 along = to - from;
        const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
        return (p - from - t * along).norm() - std::lerp(from_radius, to_radius, t);
    }
};

/// The smaller of two distances, rounded where they differ by less than `k` [m].
double smooth_min(double a, double b, double k) {
    const double overlap = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - k * overlap * overlap / 4;
}

// radii of the fingers at their joints, from root to tip [m]
constexpr std::array<std::array<double, 4>, 5> kRadii{{{0.0125, 0.0105, 0.0095, 0.0070},
                                                       {0.0098, 0.0085, 0.0076, 0.0062},
                                                       {0.0100, 0.0087, 0.0078, 0.0063},
                                                       {0.0096, 0.0082, 0.0073, 0.0060},
                                                       {0.0086, 0.0072, 0.0064, 0.0053}}};
constexpr double kCut = 0.105;  // end of the wrist, along y of the palm [m]

/// The open hand as flesh on its bones.
class Shape {
  public:
    Shape() {
        const HandPose& hand = open_hand();
        for (size_t i = 0; i < fingers_.size(); ++i) {
            const std::array<Vec3, 4>& joints = hand.fingers[i].joints;
            for (size_t k = 0; k < 3; ++k)
                fingers_[i][k] = {joints[k], joints[k + 1], kRadii[i][k], kRadii[i][k + 1]};
        }
        const auto root = [&](size_t finger) { return hand.fingers[finger].joints[0]; };
        // from the wrist to the roots of the fingers, and a little further, where the web is
        const std::array<Vec3, 4> carpals{Vec3(0.020, 0.072, -0.001), Vec3(0.030, 0.072, -0.003),
                                          Vec3(0.040, 0.072, -0.003), Vec3(0.048, 0.072, -0.001)};
        for (size_t i = 0; i < carpals.size(); ++i) {
            palm_.push_back({carpals[i], root(i + 1), 0.0130, 0.0112});
            const Vec3 web = root(i + 1) + Vec3(0, -0.012, 0.003);
            palm_.push_back({root(i + 1), web, 0.0100, 0.0080});
        }
        const Vec3 thumb = root(0), heel(0.066, 0.030, 0.004);
        palm_.push_back({{0.022, 0.070, 0.004}, thumb, 0.0140, 0.0135});                 // its ball
        palm_.push_back({thumb, root(1) + Vec3(-0.004, 0.012, 0.004), 0.0080, 0.0080});  // its web
        palm_.push_back({{0.048, 0.066, 0.002}, heel, 0.0130, 0.0115});
        palm_.push_back({heel, {0.072, 0.014, -0.004}, 0.0115, 0.0100});
        for (const double across : {0.024, 0.034, 0.044})
            palm_.push_back({{across, 0.070, 0}, {across, 0.130, 0}, 0.0165, 0.0180});
    }

    /// A box that contains the hand.
    Eigen::AlignedBox3d bounds() const {
        constexpr double kMargin = 0.01;  // for what smooth unions add [m]
        Eigen::AlignedBox3d out;
        const auto include = [&](const Flesh& part) {
            const double reach = std::max(part.from_radius, part.to_radius) + kMargin;
            for (const Vec3& end : {part.from, part.to}) {
                out.extend(end - Vec3::Constant(reach));
                out.extend(end + Vec3::Constant(reach));
            }
        };
        for (const Flesh& part : palm_) include(part);
        for (const auto& finger : fingers_) std::ranges::for_each(finger, include);
        return out;
    }
    double palm(const Vec3& p) const {
        double out = std::numeric_limits<double>::max();
        for (const Flesh& part : palm_) out = smooth_min(out, part(p), 0.010);
        return out;
    }
    /// Distance from a bone of a finger.
    double bone(size_t finger, size_t bone, const Vec3& p) const {
        return fingers_[finger][bone](p);
    }
    double finger(size_t finger, const Vec3& p) const {
        double out = bone(finger, 0, p);
        for (size_t k = 1; k < 3; ++k) out = smooth_min(out, bone(finger, k, p), 0.003);
        return out;
    }
    double operator()(const Vec3& p) const {
        const double palm = this->palm(p);
        double out = palm;
        for (size_t i = 0; i < fingers_.size(); ++i)
            out = std::min(out, smooth_min(palm, finger(i, p), 0.008));
        return -smooth_min(-out, kCut - p.y(), 0.004);
    }

  private:
    std::vector<Flesh> palm_;
    std::array<std::array<Flesh, 3>, 5> fingers_;
};

/// The pose of the bone that begins at a joint of a finger.
Pose bone_pose(const HandPose::Finger& finger, size_t joint) {
    const Vec3 along = (finger.joints[joint + 1] - finger.joints[joint]).normalized();
    const Vec3 side = along.cross(finger.back).normalized();
    Mat3 R;
    R << side, along.cross(side), along;
    return {Quat(R), finger.joints[joint]};
}

/// The motion from the open hand to `pose`, of the palm and of the bones of each finger.
std::array<std::array<Pose, 4>, 5> motions(const HandPose& pose) {
    std::array<std::array<Pose, 4>, 5> out;
    for (size_t i = 0; i < out.size(); ++i) {
        out[i][0] = pose.palm;
        for (size_t k = 0; k < 3; ++k)
            out[i][k + 1] =
                bone_pose(pose.fingers[i], k) * bone_pose(open_hand().fingers[i], k).inverse();
    }
    return out;
}

}  // namespace

HandMesh::HandMesh() {
    constexpr double kCell = 0.003;      // [m]
    constexpr double kBlending = 0.004;  // how far from a joint both of its bones matter [m]
    const Shape shape;
    const Eigen::AlignedBox3d bounds = shape.bounds();
    open_ = isosurface(shape, bounds.min(), bounds.max(), kCell);
    for (const Vertex& vertex : open_.vertices) {
        const Vec3 p = vertex.p.cast<double>();
        Hold& hold = holds_.emplace_back();
        for (size_t i = 1; i < 5; ++i) {
            if (shape.finger(i, p) < shape.finger(hold.finger, p)) hold.finger = i;
        }
        std::array<double, kBonesPerVertex> distances{shape.palm(p)};
        for (size_t k = 0; k < 3; ++k) distances[k + 1] = shape.bone(hold.finger, k, p);
        const double nearest = *std::ranges::min_element(distances);
        double sum = 0;
        for (size_t k = 0; k < kBonesPerVertex; ++k)
            sum += hold.weights[k] = std::exp(-(distances[k] - nearest) / kBlending);
        for (double& weight : hold.weights) weight /= sum;
    }
}

Triangles HandMesh::posed(const HandPose& pose) const {
    const auto moved = motions(pose);
    Triangles out = open_;
    for (size_t i = 0; i < holds_.size(); ++i) {
        const Vec3 p = open_.vertices[i].p.cast<double>(), n = open_.vertices[i].n.cast<double>();
        Vec3 p_W = Vec3::Zero(), n_W = Vec3::Zero();
        for (size_t k = 0; k < kBonesPerVertex; ++k) {
            const Pose& X = moved[holds_[i].finger][k];
            p_W += holds_[i].weights[k] * (X * p);
            n_W += holds_[i].weights[k] * (X.R * n);
        }
        out.vertices[i] = {p_W.cast<float>(), n_W.normalized().cast<float>()};
    }
    return out;
}

}  // namespace dihaptic::view
