#include "view/pick.h"

#include <Eigen/Dense>
#include <cmath>

#include "servo/displayed.h"
#include "view/triangles.h"

namespace dihaptic::view {
namespace {

/// Length of a ray up to a triangle; infinite if it misses. T. Moeller and B. Trumbore, "Fast,
/// Minimum Storage Ray/Triangle Intersection", 1997.
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

}  // namespace

Ray ray_through(const Camera& camera, double right, double up) {
    const double half = std::tan(camera.field_of_view / 2);
    const Pose X_WV = view_pose(camera);
    return {X_WV.p, (X_WV.R * Vec3(half * right, half * up, -1)).normalized()};
}

std::optional<size_t> seen_first(const scene::Scene& scene, const servo::Frame& frame,
                                 const Ray& ray) {
    std::optional<size_t> out;
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        if (!servo::is_displayed(frame, i)) continue;
        // in the measure of the body, which may be shown larger
        const Pose X_BW = servo::displayed_body(frame, i).inverse();
        const double size = servo::displayed_size(frame, i);
        const double length = size * length_to(triangles(scene.bodies[i].shape),
                                               X_BW * ray.from_W / size, X_BW.R * ray.along_W);
        if (length >= nearest) continue;
        nearest = length;
        out = i;
    }
    return out;
}

}  // namespace dihaptic::view
