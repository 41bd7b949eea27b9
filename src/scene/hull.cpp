#include "scene/hull.h"

#include <LinearMath/btConvexHullComputer.h>
extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>

namespace dihaptic::scene {
namespace {

/// The normal of a face, with twice the face's area as its length.
Vec3 twice_area(const Hull& hull, const std::vector<int>& face) {
    Vec3 out = Vec3::Zero();
    const Vec3& first = hull.vertices[static_cast<size_t>(face[0])];
    for (size_t i = 1; i + 1 < face.size(); ++i)
        out += (hull.vertices[static_cast<size_t>(face[i])] - first)
                   .cross(hull.vertices[static_cast<size_t>(face[i + 1])] - first);
    return out;
}

double area(const Hull& hull) {
    double sum = 0;
    for (const std::vector<int>& face : hull.faces) sum += twice_area(hull, face).norm() / 2;
    return sum;
}

/// Computes a hull with Bullet, which rounds coordinates to a ten-thousandth of their extent, and
/// merges corners or flips faces that are closer together than this.
Hull quick_hull(std::span<const Vec3> points) {
    Hull hull;
    btConvexHullComputer computer;
    computer.compute(points.front().data(), sizeof(Vec3), static_cast<int>(points.size()), 0, 0);
    // uses the original points, which are exact
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
    return hull;
}

/// Whether, up to rounding, every face is flat and all points lie behind it. Hulls of very many
/// points are not checked, because this would take too long.
bool is_exact(const Hull& hull, std::span<const Vec3> points, double extent) {
    constexpr double kMostWork = 1e8;
    constexpr double kThin = 1e-9;      // thickness of a face, as a fraction of the extent
    constexpr double kRounding = 1e-7;  // rounding in files, as a fraction of the extent
    if (static_cast<double>(hull.faces.size()) * static_cast<double>(points.size()) > kMostWork)
        return false;
    return std::all_of(hull.faces.begin(), hull.faces.end(), [&](const std::vector<int>& face) {
        const Vec3 area = twice_area(hull, face);
        if (!(area.norm() > kThin * extent * extent)) return false;
        const Vec3 n = area.normalized();
        const double offset = n.dot(hull.vertices[static_cast<size_t>(face[0])]);
        const double off = kRounding * extent;
        return std::all_of(face.begin(), face.end(),
                           [&](int v) {
                               return n.dot(hull.vertices[static_cast<size_t>(v)]) > offset - off;
                           }) &&
               std::all_of(points.begin(), points.end(),
                           [&](const Vec3& p) { return n.dot(p) < offset + off; });
    });
}

/// The state of Qhull, which has to be freed.
class Qhull {
  public:
    explicit Qhull(std::span<const Vec3> points) : coordinates_(points.begin(), points.end()) {
        qh_zero(&state_, nullptr);
        char options[] = "qhull";
        const std::unique_ptr<FILE, int (*)(FILE*)> unheard(std::fopen("/dev/null", "w"),
                                                            &std::fclose);
        failed_ =
            qh_new_qhull(&state_, 3, static_cast<int>(points.size()), coordinates_.front().data(),
                         0, options, unheard.get(), unheard.get()) != 0;
    }
    ~Qhull() {
        qh_freeqhull(&state_, qh_ALL);
        int kept = 0;
        int total = 0;
        qh_memfreeshort(&state_, &kept, &total);
    }
    Qhull(const Qhull&) = delete;
    Qhull& operator=(const Qhull&) = delete;

    Hull hull() {
        Hull out;
        if (failed_) return out;
        std::map<int, int> index;  // indexed by the number of the point
        for (facetT* facet = state_.facet_list; facet != nullptr && facet->next != nullptr;
             facet = facet->next) {
            std::vector<int>& face = out.faces.emplace_back();
            setT* const corners = qh_facet3vertex(&state_, facet);
            for (int k = 0; k < qh_setsize(&state_, corners); ++k) {
                const auto* corner = static_cast<vertexT*>(SETelem_(corners, k));
                const int point = qh_pointid(&state_, corner->point);
                const auto [at, is_new] =
                    index.try_emplace(point, static_cast<int>(out.vertices.size()));
                if (is_new) out.vertices.push_back(coordinates_[static_cast<size_t>(point)]);
                face.push_back(at->second);
            }
            qh_settempfree_all(&state_);
            const Vec3 outward(facet->normal[0], facet->normal[1], facet->normal[2]);
            if (twice_area(out, face).dot(outward) < 0) std::reverse(face.begin(), face.end());
        }
        return out;
    }

  private:
    std::vector<Vec3> coordinates_;
    qhT state_;
    bool failed_ = false;
};

}  // namespace

Hull convex_hull(std::span<const Vec3> points) {
    if (points.size() < 4) return {};
    for (const Vec3& point : points) {
        if (!point.allFinite()) return {};
    }
    Vec3 low = points.front();
    Vec3 high = low;
    for (const Vec3& p : points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const double extent = (high - low).norm();
    Hull hull = quick_hull(points);
    // Bullet is tried first, because recordings depend on the order of its corners and faces
    if (hull.faces.size() < 4 || !is_exact(hull, points, extent)) hull = Qhull(points).hull();
    if (hull.faces.size() < 4) return {};
    // needles and leaves are refused, because their volume or area consists only of rounding errors
    const double surface = area(hull);
    const double thickness = 2 * integrate(hull.vertices, hull.faces).volume / surface;
    if (!(surface > 1e-6 * extent * extent && thickness > 1e-6 * extent)) return {};
    return hull;
}

VolumeIntegrals integrate(std::span<const Vec3> vertices, std::span<const std::vector<int>> faces) {
    double volume = 0;
    Vec3 first = Vec3::Zero();   // integral of x
    Mat3 second = Mat3::Zero();  // integral of x x^T
    // far from the origin, the tetrahedra would nearly cancel out, leaving only rounding errors
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
