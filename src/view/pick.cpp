#include "view/pick.h"

#include <Eigen/Dense>
#include <cmath>

#include "frame/displayed.h"
#include "view/triangles.h"

namespace dihaptic::view {
namespace {

/// Distance along a ray to a triangle; infinite if the ray misses the triangle. T. Moeller and B.
/// Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
double length_to(const Vec3& from, const Vec3& along, const Vec3& a, const Vec3& b, const Vec3& c) {
    constexpr double kMisses = std::numeric_limits<double>::infinity();
    const Vec3 ab = b - a, ac = c - a;
    const Vec3 across = along.cross(ac);
    const double det = ab.dot(across);
    if (std::abs(det) < 1e-18) return kMisses;
    const Vec3 to = from - a;
    const double u = to.dot(across) / det;
    const Vec3 q = to.cross(ab);
    const double v = along.dot(q) / det;
    if (u < 0 || v < 0 || u + v > 1) return kMisses;
    const double length = ac.dot(q) / det;
    return length > 0 ? length : kMisses;
}

double length_to(const Triangles& surface, const Vec3& from, const Vec3& along) {
    double nearest = std::numeric_limits<double>::infinity();
    const auto corner = [&](size_t i) -> Vec3 {
        return surface.vertices[surface.indices[i]].p.cast<double>();
    };
    for (size_t i = 0; i + 2 < surface.indices.size(); i += 3)
        nearest =
            std::min(nearest, length_to(from, along, corner(i), corner(i + 1), corner(i + 2)));
    return nearest;
}

/// Largest distance at which bodies can be dragged toward the horizon [m].
constexpr double kHorizon = 5;
/// Smallest horizontal part of a line of sight from which heights can still be judged.
constexpr double kSteep = 0.05;

/// The point where a ray meets a plane; nullopt if there is none or if it is beyond kHorizon.
std::optional<Vec3> meeting(const Ray& ray, const Vec3& through_W, const Vec3& normal) {
    const double toward = ray.along_W.dot(normal);
    const double length = (through_W - ray.from_W).dot(normal) / toward;
    if (!(length > 0 && length < kHorizon)) return {};
    return ray.from_W + length * ray.along_W;
}

}  // namespace

Ray ray_through(const Camera& camera, double right, double up) {
    const double half = std::tan(camera.field_of_view / 2);
    const Pose X_WV = view_pose(camera);
    return {X_WV.p, (X_WV.R * Vec3(half * right, half * up, -1)).normalized()};
}

std::optional<Seen> seen_first(const scene::Scene& scene, const frame::Frame& frame,
                               const Ray& ray) {
    std::optional<Seen> out;
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        if (!frame::is_displayed(frame, i)) continue;
        // computed at the body's own scale, because the body may be displayed enlarged
        const Pose X_BW = frame::displayed_body(frame, i).inverse();
        const double size = frame::displayed_size(frame, i);
        const double length = size * length_to(triangles(scene.bodies[i]), X_BW * ray.from_W / size,
                                               X_BW.R * ray.along_W);
        if (length >= nearest) continue;
        nearest = length;
        out = Seen{i, ray.from_W + length * ray.along_W};
    }
    return out;
}

std::optional<Vec3> dragged(const Vec3& held_W, const Ray& from, const Ray& to, bool upright) {
    // to move along z, use the pointer's path in the upright plane that faces the viewer
    const Vec3 level(to.along_W.x(), to.along_W.y(), 0);
    if (upright && level.norm() < kSteep) return {};
    const Vec3 normal = upright ? Vec3(level.normalized()) : Vec3(Vec3::UnitZ());
    const auto a = meeting(from, held_W, normal), b = meeting(to, held_W, normal);
    if (!a || !b) return {};
    const Vec3 way = *b - *a;
    return upright ? Vec3(0, 0, way.z()) : Vec3(way.x(), way.y(), 0);
}

}  // namespace dihaptic::view
