#include "haptics/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/polyhedron.h"

namespace dihaptic::haptics {
namespace {

using scene::ShapeKind;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Roots s of |p + s d| = r for p outside and d pointing towards the origin, in any number of
/// dimensions. The formula for the first root avoids subtracting nearly equal numbers.
struct Roots {
    double first = kInfinity;
    double last = -kInfinity;
};

template <class Vector>
Roots ball_roots(const Vector& p, const Vector& d, double r) {
    const double a = d.squaredNorm();
    const double b = p.dot(d);
    const double c = p.squaredNorm() - r * r;
    const double inside = b * b - a * c;
    if (a <= 0 || inside < 0) return {};
    const double root = std::sqrt(inside);
    if (b < 0) return {c / (-b + root), (-b + root) / a};
    return {(-b - root) / a, root + b > 0 ? -c / (b + root) : 0.0};
}

/// The part of a straight path that is inside a cone which extends infinitely below its tip, i.e.
/// where the length of q + s e is at most l - s k. Either root may be infinite.
Roots cone_roots(const Eigen::Vector2d& q, const Eigen::Vector2d& e, double l, double k) {
    const double a = e.squaredNorm() - k * k;
    const double b = q.dot(e) + l * k;
    const double c = q.squaredNorm() - l * l;
    const double inside = b * b - a * c;
    if (a > 0 && inside < 0) return {};
    const double root = std::sqrt(std::max(0.0, inside));
    const double sum = b < 0 ? -b + root : -b - root;
    const double near = sum != 0 ? c / sum : 0.0;
    if (a == 0) {  // parallel to a line of the side: the other root is at infinity
        if (k < 0 && b < 0) return {near, kInfinity};
        if (k > 0 && b > 0) return {-kInfinity, near};
        return {};
    }
    const double far = sum / a;
    const double first = std::min(near, far);
    const double last = std::max(near, far);
    if (a < 0) return k < 0 ? Roots{last, kInfinity} : Roots{-kInfinity, first};
    // the path is inside between the roots, unless they belong to the cone's mirror image above its
    // tip, where l - s k is negative
    return l + b / a * k < 0 ? Roots{} : Roots{first, last};
}

/// The part of p + s d that is inside the side c r + s z = radius, with r the distance from the z
/// axis; s = 0 for a cylinder.
Roots side_roots(const Vec3& p, const Vec3& d, double c, double s, double radius) {
    const Eigen::Vector2d q = p.head<2>();
    const Eigen::Vector2d e = d.head<2>();
    if (s > 0) return cone_roots(c * q, c * e, radius - s * p.z(), s * d.z());
    if (e.squaredNorm() > 0) return ball_roots(q, e, radius);
    return q.norm() > radius ? Roots{} : Roots{-kInfinity, kInfinity};
}

}  // namespace

Surface::Surface(const scene::Shape& shape, double skin, bool has_seams)
    : kind_(shape.kind), has_seams_(has_seams) {
    switch (kind_) {
        case ShapeKind::box:
        case ShapeKind::mesh: {
            const dynamics::Polyhedron hull = kind_ == ShapeKind::box
                                                  ? dynamics::Polyhedron::box(shape.size)
                                                  : dynamics::Polyhedron::of(shape.hull);
            Vec3 centre = Vec3::Zero();
            for (const Vec3& v : hull.vertices)
                centre += v / static_cast<double>(hull.vertices.size());
            double inner = kInfinity;
            for (const auto& face : hull.faces) {
                flats_.push_back({face.normal, face.offset + skin});
                inner = std::min(inner, face.offset - face.normal.dot(centre));
            }
            // when moved outward, the faces stay within the shape scaled by 1 + skin / inner about
            // an inner point
            for (const Vec3& v : hull.vertices)
                reach_ = std::max(reach_, centre.norm() + (v - centre).norm() * (1 + skin / inner));
            break;
        }
        case ShapeKind::plane:
            flats_.push_back({Vec3::UnitZ(), skin});
            reach_ = kInfinity;
            break;
        case ShapeKind::sphere:
            radius_ = reach_ = shape.radius + skin;
            break;
        case ShapeKind::capsule:
            radius_ = shape.radius + skin;
            half_ = shape.length / 2;
            reach_ = radius_ + half_;
            break;
        case ShapeKind::cylinder:
            radius_ = base_radius_ = shape.radius + skin;
            half_ = shape.length / 2 + skin;
            reach_ = std::hypot(radius_, half_);
            flats_.push_back({Vec3::UnitZ(), half_});
            flats_.push_back({-Vec3::UnitZ(), half_});
            break;
        case ShapeKind::cone: {
            const double slope = std::hypot(shape.radius, shape.length);
            lean_ = {shape.length / slope, shape.radius / slope};
            half_ = shape.length / 2 + skin;
            radius_ = lean_.s * shape.length / 2 + skin;
            base_radius_ = (radius_ + lean_.s * half_) / lean_.c;
            reach_ = std::max(radius_ / lean_.s, std::hypot(base_radius_, half_));
            flats_.push_back({-Vec3::UnitZ(), half_});
            break;
        }
        case ShapeKind::compound:
            break;  // only the parts of a compound have surfaces
    }
}

Vec3 Surface::axis_point(const Vec3& p) const noexcept {
    return kind_ == ShapeKind::capsule ? Vec3(0, 0, std::clamp(p.z(), -half_, half_))
                                       : Vec3(Vec3::Zero());
}

double Surface::side_distance(const Vec3& p) const noexcept {
    return lean_.c * p.head<2>().norm() + lean_.s * p.z() - radius_;
}

double Surface::distance(int face, const Vec3& p) const noexcept {
    if (is_flat(face)) {
        const Flat& flat = flats_[static_cast<size_t>(face)];
        return flat.n.dot(p) - flat.offset;
    }
    if (has_side()) return side_distance(p);
    return (p - axis_point(p)).norm() - radius_;
}

Vec3 Surface::normal(int face, const Vec3& p) const noexcept {
    if (is_flat(face)) return flats_[static_cast<size_t>(face)].n;
    const Vec3 from_axis = has_side() ? Vec3(p.x(), p.y(), 0) : Vec3(p - axis_point(p));
    const double size = from_axis.norm();
    // on the axis, any direction is valid
    const Vec3 away = size > 0 ? Vec3(from_axis / size) : Vec3(Vec3::UnitX());
    return is_cone() ? Vec3(lean_.c * away + lean_.s * Vec3::UnitZ()) : away;
}

double Surface::separation(const Vec3& p) const noexcept {
    if (flats_.empty()) return distance(0, p);
    double out = has_side() ? side_distance(p) : -kInfinity;
    for (const Flat& flat : flats_) out = std::max(out, flat.n.dot(p) - flat.offset);
    return out;
}

int Surface::shallowest(const Vec3& p) const noexcept {
    int best = 0;
    double largest = -kInfinity;
    for (int face = 0; face < std::max(1, faces()); ++face) {
        const double d = distance(face, p);
        if (d > largest) {
            largest = d;
            best = face;
        }
    }
    return best;
}

std::optional<Surface::Entry> Surface::enter(const Vec3& p, const Vec3& d) const noexcept {
    const double apart = separation(p);
    if (apart > d.norm() + kOnSurface) return {};
    if (apart > kOnSurface && flats_.empty()) return enter_ball(p, d);
    if (apart > kOnSurface) return over_seams(enter_faces(p, d), p, d);
    // Faces through p: since a convex solid lies below each of them, a path is blocked only if all
    // of them block it. Among blocking faces, p first slides along the one that blocks least.
    Entry least{0, -1};
    double fastest = -kInfinity;
    for (int face = 0; face < std::max(1, faces()); ++face) {
        if (distance(face, p) < std::min(apart, 0.0) - kOnSurface) continue;
        const double leaving = normal(face, p).dot(d);
        if (leaving >= 0) return {};
        if (leaving > fastest) {
            fastest = leaving;
            least.face = face;
        }
    }
    return least.face < 0 ? std::nullopt : std::optional(least);
}

std::optional<Surface::Entry> Surface::enter_ball(const Vec3& p, const Vec3& d) const noexcept {
    double first = kInfinity;
    const auto ball = [&](double z) {
        const Vec3 q = p - Vec3(0, 0, z);
        if (q.dot(d) < 0) first = std::min(first, ball_roots(q, d, radius_).first);
    };
    if (kind_ == ShapeKind::sphere) {
        ball(0);
    } else {
        ball(half_);
        ball(-half_);
        const Eigen::Vector2d q = p.head<2>();
        const Eigen::Vector2d e = d.head<2>();
        if (q.squaredNorm() >= radius_ * radius_ && q.dot(e) < 0) {
            const double s = ball_roots(q, e, radius_).first;
            if (std::abs(p.z() + s * d.z()) <= half_) first = std::min(first, s);
        }
    }
    if (first > 1) return {};
    return Entry{std::max(0.0, first), 0};
}

std::optional<Surface::Entry> Surface::enter_faces(const Vec3& p, const Vec3& d) const noexcept {
    Entry entry{-kInfinity, -1};
    double exit = kInfinity;
    for (size_t i = 0; i < flats_.size(); ++i) {
        const double above = flats_[i].n.dot(p) - flats_[i].offset;
        const double speed = flats_[i].n.dot(d);
        if (speed < 0) {
            const double s = -above / speed;
            if (s > entry.share) entry = {s, static_cast<int>(i)};
        } else if (speed > 0) {
            exit = std::min(exit, -above / speed);
        } else if (above > 0) {
            return {};
        }
    }
    if (has_side()) {
        const Roots s = side_roots(p, d, lean_.c, lean_.s, radius_);
        if (s.first > entry.share) entry = {s.first, static_cast<int>(flats_.size())};
        exit = std::min(exit, s.last);
    }
    if (entry.face < 0 || entry.share > exit || entry.share < 0 || entry.share > 1) return {};
    return entry;
}

std::optional<Surface::Entry> Surface::over_seams(std::optional<Entry> entry, const Vec3& p,
                                                  const Vec3& d) const noexcept {
    if (!has_seams_ || !entry || !is_flat(entry->face)) return entry;
    const Vec3 at = p + entry->share * d;
    for (int face = 0; face < static_cast<int>(flats_.size()); ++face) {
        const Flat& flat = flats_[static_cast<size_t>(face)];
        if (face == entry->face || flat.n.dot(at) - flat.offset < -kSeam) continue;
        // the path leads along that face or away from it, so it does not enter the part
        if (flat.n.dot(p + d) - flat.offset >= -kSeam) return {};
        entry->face = face;
        return entry;
    }
    return entry;
}

Surface::Crossing Surface::cross(int face, const Vec3& p, const Vec3& d) const noexcept {
    Crossing out;
    if (flats_.empty()) return out;
    const auto at = [&](double share, int beyond) {
        if (share < out.share) out = {std::max(0.0, share), beyond};
    };
    for (int i = 0; i < static_cast<int>(flats_.size()); ++i) {
        const Flat& flat = flats_[static_cast<size_t>(i)];
        const double speed = flat.n.dot(d);
        // a face nearly parallel to this one cannot share an edge with it
        if (i != face && speed > 1e-12 * d.norm()) at((flat.offset - flat.n.dot(p)) / speed, i);
    }
    if (has_side() && is_flat(face)) {
        const Eigen::Vector2d q = p.head<2>();
        const Eigen::Vector2d e = d.head<2>();
        if (e.squaredNorm() > 0 && q.dot(e) > 0) {
            const double past = q.squaredNorm() - base_radius_ * base_radius_;
            at(past >= 0 ? 0 : ball_roots(q, e, base_radius_).last,
               static_cast<int>(flats_.size()));
        } else if (e.squaredNorm() > 0) {
            const double last = ball_roots(q, e, base_radius_).last;
            if (last > 0) at(last, static_cast<int>(flats_.size()));
        }
    }
    return out;
}

Vec3 Surface::bent_part(int face, const Vec3& p, const Vec3& d) const noexcept {
    if (is_flat(face)) return Vec3::Zero();
    if (is_cone()) {
        const Vec3 around(-p.y(), p.x(), 0);
        const double squared = around.squaredNorm();
        return squared > 0 ? Vec3(around.dot(d) / squared * around) : Vec3(Vec3::Zero());
    }
    const bool straight_along_z =
        has_side() || (kind_ == ShapeKind::capsule && std::abs(p.z()) < half_);
    return straight_along_z ? Vec3(d.x(), d.y(), 0) : d;
}

double Surface::bend_radius(const Vec3& p) const noexcept {
    return is_cone() ? p.head<2>().norm() / lean_.c : radius_;
}

}  // namespace dihaptic::haptics
