#include "scene/hull.h"

#include <LinearMath/btConvexHullComputer.h>

namespace dihaptic::scene {
namespace {

double area(const Hull& hull) {
    double sum = 0;
    for (const std::vector<int>& face : hull.faces) {
        Vec3 twice = Vec3::Zero();
        const Vec3& first = hull.vertices[static_cast<size_t>(face[0])];
        for (size_t i = 1; i + 1 < face.size(); ++i)
            twice += (hull.vertices[static_cast<size_t>(face[i])] - first)
                         .cross(hull.vertices[static_cast<size_t>(face[i + 1])] - first);
        sum += twice.norm() / 2;
    }
    return sum;
}

}  // namespace

Hull convex_hull(std::span<const Vec3> points) {
    Hull hull;
    if (points.size() < 4) return hull;
    for (const Vec3& point : points) {
        if (!point.allFinite()) return hull;
    }
    btConvexHullComputer computer;
    computer.compute(points.front().data(), sizeof(Vec3), static_cast<int>(points.size()), 0, 0);
    // the computer rounds coordinates; the original points are exact
    for (int i = 0; i < computer.vertices.size(); ++i) {
        hull.vertices.push_back(points[static_cast<size_t>(computer.original_vertex_index[i])]);
    }
    for (int f = 0; f < computer.faces.size(); ++f) {
        std::vector<int> face;
        const btConvexHullComputer::Edge* first = &computer.edges[computer.faces[f]];
        const btConvexHullComputer::Edge* edge = first;
        do {
            face.push_back(edge->getSourceVertex());
            edge = edge->getNextEdgeOfFace();
        } while (edge != first);
        hull.faces.push_back(std::move(face));
    }
    if (hull.vertices.empty()) return hull;
    Vec3 low = hull.vertices.front();
    Vec3 high = low;
    for (const Vec3& v : hull.vertices) {
        low = low.cwiseMin(v);
        high = high.cwiseMax(v);
    }
    if (hull.faces.size() < 4) return {};
    // neither a needle nor a leaf, whose volume and area are but rounding
    const double extent = (high - low).norm();
    const double surface = area(hull);
    const double thickness = 2 * integrate(hull.vertices, hull.faces).volume / surface;
    if (!(surface > 1e-6 * extent * extent && thickness > 1e-6 * extent)) return {};
    return hull;
}

VolumeIntegrals integrate(std::span<const Vec3> vertices, std::span<const std::vector<int>> faces) {
    double volume = 0;
    Vec3 first = Vec3::Zero();   // integral of x
    Mat3 second = Mat3::Zero();  // integral of x x^T
    // far from the origin the tetrahedra would cancel each other, and leave their rounding
    constexpr double kFar = 1;  // [m]
    const bool is_far = !vertices.empty() && vertices.front().norm() > kFar;
    const Vec3 origin = is_far ? vertices.front() : Vec3::Zero();
    for (const std::vector<int>& face : faces) {
        for (size_t i = 1; i + 1 < face.size(); ++i) {
            const Vec3 a = vertices[static_cast<size_t>(face[0])] - origin;
            const Vec3 b = vertices[static_cast<size_t>(face[i])] - origin;
            const Vec3 c = vertices[static_cast<size_t>(face[i + 1])] - origin;
            const double six_volumes = a.dot(b.cross(c));
            const Vec3 sum = a + b + c;
            volume += six_volumes / 6;
            first += six_volumes / 24 * sum;
            second +=
                six_volumes / 120 *
                (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
        }
    }
    VolumeIntegrals out;
    out.volume = volume;
    if (volume <= 0) return out;
    out.centre = first / volume;
    const Mat3 about_centre = second - volume * out.centre * out.centre.transpose();
    out.inertia = about_centre.trace() * Mat3::Identity() - about_centre;
    out.centre += origin;
    return out;
}

}  // namespace dihaptic::scene
