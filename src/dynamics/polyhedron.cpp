#include "dynamics/polyhedron.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/patch.h"

namespace dihaptic::dynamics {
namespace {

/// The face of `a` that best separates it from `b`, whose vertices are given in a's frame.
struct FaceQuery {
    double separation = -kInfinity;
    int face = -1;
    int flush = -1;  ///< a face with which `b` is flush, or -1
};

/// Finds the best separating face. `way` is the displacement of b relative to a in the coming step,
/// in a's frame.
FaceQuery query_faces(const Polyhedron& a, const Polyhedron& b, const Pose& X_AB, double margin,
                      const Vec3& way) {
    FaceQuery best;
    const Mat3 R_BA = X_AB.R.conjugate().toRotationMatrix();
    for (size_t f = 0; f < a.faces.size(); ++f) {
        // use the plane in b's frame, so that b's vertices need not be transformed
        const Vec3 n = R_BA * a.faces[f].normal;
        const double offset = a.faces[f].offset - a.faces[f].normal.dot(X_AB.p);
        double lowest = kInfinity;
        for (const Vec3& v : b.vertices) lowest = std::min(lowest, n.dot(v));
        const double separation = lowest - offset;
        if (is_flush(separation, a.faces[f].normal, way)) best.flush = static_cast<int>(f);
        if (separation > best.separation) {
            best.separation = separation;
            best.face = static_cast<int>(f);
        }
        if (separation > margin) break;  // the shapes are apart: other faces are irrelevant
    }
    return best;
}

/// The pair of edges that separates the shapes best, in a's frame.
struct EdgeQuery {
    double separation = -kInfinity;
    Vec3 axis = Vec3::Zero();  ///< points from a to b
    int direction_a = -1;
    int direction_b = -1;
};

EdgeQuery query_edges(const Polyhedron& a, const Polyhedron& b, const Pose& X_AB, double margin) {
    EdgeQuery best;
    const Mat3 R_AB = X_AB.R.toRotationMatrix();
    for (size_t i = 0; i < a.directions.size(); ++i) {
        for (size_t j = 0; j < b.directions.size(); ++j) {
            Vec3 axis = a.directions[i].cross(R_AB * b.directions[j]);
            const double size = axis.norm();
            if (size < 1e-4) continue;  // edges are parallel: a face axis suffices
            axis /= size;
            double a_low = kInfinity, a_high = -kInfinity, b_low = kInfinity, b_high = -kInfinity;
            for (const Vec3& v : a.vertices) {
                const double d = axis.dot(v);
                a_low = std::min(a_low, d);
                a_high = std::max(a_high, d);
            }
            const Vec3 axis_B = R_AB.transpose() * axis;
            const double shift = axis.dot(X_AB.p);
            for (const Vec3& v : b.vertices) {
                const double d = axis_B.dot(v) + shift;
                b_low = std::min(b_low, d);
                b_high = std::max(b_high, d);
            }
            const double above = b_low - a_high;
            const double below = a_low - b_high;
            const double separation = std::max(above, below);
            if (separation > best.separation) {
                best = {separation, above > below ? axis : Vec3(-axis), static_cast<int>(i),
                        static_cast<int>(j)};
            }
            if (separation > margin) return best;
        }
    }
    return best;
}

/// Returns the edge farthest along the axis among the edges with a given direction.
Polyhedron::Edge support_edge(const Polyhedron& p, int direction, const Vec3& axis) {
    const Polyhedron::Edge* best = nullptr;
    double furthest = -kInfinity;
    for (const Polyhedron::Edge& edge : p.edges) {
        if (edge.direction != direction) continue;
        const double d = axis.dot(p.vertices[static_cast<size_t>(edge.from)] +
                                  p.vertices[static_cast<size_t>(edge.to)]);
        if (d > furthest) {
            furthest = d;
            best = &edge;
        }
    }
    return *best;
}

/// Clips the face of `other` that is most opposed to the reference face. Each point of the patch is
/// a pair (on the reference, on the other); its normal points away from the reference.
void face_contact(const Polyhedron& ref, const Pose& X_WR, int face, const Polyhedron& other,
                  const Pose& X_WO, double margin, ContactPatch& patch) {
    const Polyhedron::Face& reference = ref.faces[static_cast<size_t>(face)];
    const Pose X_RO = X_WR.inverse() * X_WO;
    const Vec3 n_O = X_RO.R.conjugate() * reference.normal;
    size_t incident = 0;
    double most_opposed = kInfinity;
    for (size_t f = 0; f < other.faces.size(); ++f) {
        const double d = other.faces[f].normal.dot(n_O);
        if (d < most_opposed) {
            most_opposed = d;
            incident = f;
        }
    }
    std::array<Polygon, 2> polygons;  // used alternately, because they are too large to copy
    size_t current = 0;
    for (const int v : other.faces[incident].vertices)
        polygons[current].add(X_RO * other.vertices[static_cast<size_t>(v)]);
    for (const Polyhedron::Side& side : reference.sides) {
        clip(polygons[current], side.normal, side.offset, polygons[1 - current]);
        current = 1 - current;
    }
    const Polygon& polygon = polygons[current];
    Polygon near;
    Gaps gaps;
    for (size_t i = 0; i < polygon.count; ++i) {
        const double gap = reference.normal.dot(polygon.points[i]) - reference.offset;
        if (gap > margin) continue;
        gaps[near.count] = gap;
        near.add(polygon.points[i]);
    }
    std::array<size_t, 4> kept{};
    reduce(near, gaps, reference.normal, kept, patch.count);
    patch.n_W = X_WR.R * reference.normal;
    for (int i = 0; i < patch.count; ++i) {
        const size_t k = kept[static_cast<size_t>(i)];
        const Vec3 on_other = X_WR * near.points[k];
        patch.points[static_cast<size_t>(i)] = {on_other - gaps[k] * patch.n_W, on_other, gaps[k]};
    }
}

void edge_contact(const Polyhedron& a, const Pose& X_WA, const Polyhedron& b, const Pose& X_AB,
                  const EdgeQuery& query, ContactPatch& patch) {
    const Polyhedron::Edge ea = support_edge(a, query.direction_a, query.axis);
    const Polyhedron::Edge eb =
        support_edge(b, query.direction_b, X_AB.R.conjugate() * Vec3(-query.axis));
    const Vec3 pa = a.vertices[static_cast<size_t>(ea.from)];
    const Vec3 da = a.vertices[static_cast<size_t>(ea.to)] - pa;
    const Vec3 pb = X_AB * b.vertices[static_cast<size_t>(eb.from)];
    const Vec3 db = X_AB * b.vertices[static_cast<size_t>(eb.to)] - pb;
    // closest points of the two lines, clamped to the ends of the edges
    const Vec3 r = pa - pb;
    const double aa = da.squaredNorm(), bb = db.squaredNorm(), ab = da.dot(db);
    const double det = aa * bb - ab * ab;
    const double s = std::clamp((ab * db.dot(r) - bb * da.dot(r)) / det, 0.0, 1.0);
    const double t = std::clamp((aa * db.dot(r) - ab * da.dot(r)) / det, 0.0, 1.0);
    patch.n_W = X_WA.R * query.axis;
    patch.count = 1;
    patch.points[0] = {X_WA * Vec3(pa + s * da), X_WA * Vec3(pb + t * db), query.separation};
}

}  // namespace

void clip(const Polygon& in, const Vec3& n, double offset, Polygon& out) {
    out.count = 0;
    for (size_t i = 0; i < in.count; ++i) {
        const Vec3& p = in.points[i];
        const Vec3& q = in.points[(i + 1) % in.count];
        const double dp = n.dot(p) - offset;
        const double dq = n.dot(q) - offset;
        if (dp <= 0) out.add(p);
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) out.add(p + dp / (dp - dq) * (q - p));
    }
}

void reduce(const Polygon& points, const Gaps& gaps, const Vec3& n, std::array<size_t, 4>& kept,
            int& count) {
    if (points.count <= 4) {
        count = static_cast<int>(points.count);
        for (size_t i = 0; i < points.count; ++i) kept[i] = i;
        return;
    }
    size_t deepest = 0;
    for (size_t i = 1; i < points.count; ++i) {
        if (gaps[i] < gaps[deepest] - 1e-9) deepest = i;
    }
    size_t furthest = deepest;
    double most = -1;
    for (size_t i = 0; i < points.count; ++i) {
        const double d = (points.points[i] - points.points[deepest]).squaredNorm();
        if (d > most + 1e-12) {
            most = d;
            furthest = i;
        }
    }
    const Vec3 line = points.points[furthest] - points.points[deepest];
    size_t left = deepest, right = deepest;
    double left_area = 0, right_area = 0;
    for (size_t i = 0; i < points.count; ++i) {
        const double area = line.cross(points.points[i] - points.points[deepest]).dot(n);
        if (area > left_area + 1e-15) {
            left_area = area;
            left = i;
        }
        if (area < right_area - 1e-15) {
            right_area = area;
            right = i;
        }
    }
    count = 0;
    kept[static_cast<size_t>(count++)] = deepest;
    kept[static_cast<size_t>(count++)] = furthest;
    if (left != deepest) kept[static_cast<size_t>(count++)] = left;
    if (right != deepest) kept[static_cast<size_t>(count++)] = right;
}

void keep_near(const Polygon& points, double offset, double margin, ContactPatch& patch) {
    Polygon near;
    Gaps gaps;
    for (size_t i = 0; i < points.count; ++i) {
        const double gap = patch.n_W.dot(points.points[i]) - offset;
        if (gap > margin) continue;
        gaps[near.count] = gap;
        near.add(points.points[i]);
    }
    std::array<size_t, 4> kept{};
    reduce(near, gaps, patch.n_W, kept, patch.count);
    for (int i = 0; i < patch.count; ++i) {
        const size_t k = kept[static_cast<size_t>(i)];
        patch.points[static_cast<size_t>(i)] = {near.points[k] - gaps[k] * patch.n_W,
                                                near.points[k], gaps[k]};
    }
}

bool is_covered(const Polyhedron& polyhedron, const Pose& X_WP, const Vec3& outward_W) {
    constexpr double kAlike = 1 - 1e-6;
    return std::any_of(
        polyhedron.covered.begin(), polyhedron.covered.end(),
        [&](const Vec3& normal) { return (X_WP.R * normal).dot(outward_W) > kAlike; });
}

Polyhedron Polyhedron::of(const scene::Hull& hull) {
    Polyhedron out;
    out.vertices = hull.vertices;
    for (const std::vector<int>& loop : hull.faces) {
        Face face;
        face.vertices = loop;
        // use Newell's normal, which is robust for polygons with many vertices
        Vec3 normal = Vec3::Zero();
        for (size_t i = 0; i < loop.size(); ++i) {
            const Vec3& p = out.vertices[static_cast<size_t>(loop[i])];
            const Vec3& q = out.vertices[static_cast<size_t>(loop[(i + 1) % loop.size()])];
            normal += p.cross(q);
            const int from = loop[i];
            const int to = loop[(i + 1) % loop.size()];
            if (from < to) out.edges.push_back({from, to, 0});
        }
        face.normal = normal.normalized();
        face.offset = face.normal.dot(out.vertices[static_cast<size_t>(loop.front())]);
        for (size_t i = 0; i < loop.size(); ++i) {
            const Vec3& p = out.vertices[static_cast<size_t>(loop[i])];
            const Vec3& q = out.vertices[static_cast<size_t>(loop[(i + 1) % loop.size()])];
            const Vec3 outward = (q - p).cross(face.normal).normalized();
            face.sides.push_back({outward, outward.dot(p)});
        }
        out.faces.push_back(std::move(face));
    }
    for (Edge& edge : out.edges) {
        const Vec3 d = (out.vertices[static_cast<size_t>(edge.to)] -
                        out.vertices[static_cast<size_t>(edge.from)])
                           .normalized();
        const auto same =
            std::find_if(out.directions.begin(), out.directions.end(),
                         [&](const Vec3& known) { return known.cross(d).norm() < 1e-6; });
        edge.direction = static_cast<int>(same - out.directions.begin());
        if (same == out.directions.end()) out.directions.push_back(d);
    }
    return out;
}

Polyhedron Polyhedron::box(const Vec3& size) {
    scene::Hull hull;
    for (int i = 0; i < 8; ++i) {
        hull.vertices.push_back(
            size.cwiseProduct(Vec3(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5)));
    }
    hull.faces = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                  {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    return of(hull);
}

namespace {

/// The face to which a contact belongs; if both indices are -1, it belongs to two edges.
struct Choice {
    int face_of_a = -1;
    int face_of_b = -1;
};

/// Chooses the face of the best axis, or the face with which the shapes are flush.
Choice choose(const Polyhedron& a, const Polyhedron& b, const Pose& X_AB, const FaceQuery& on_a,
              const FaceQuery& on_b, const EdgeQuery& edges) {
    const auto of_a = [&](int face) { return a.faces[static_cast<size_t>(face)].normal; };
    const auto of_b = [&](int face) {
        return Vec3(X_AB.R * -b.faces[static_cast<size_t>(face)].normal);
    };
    const bool by_edge =
        edges.separation > std::max(on_a.separation, on_b.separation) + kFacePreference;
    const bool by_a = on_a.separation + kFacePreference >= on_b.separation;
    const Vec3 axis = by_edge ? edges.axis : by_a ? of_a(on_a.face) : of_b(on_b.face);
    const auto counts = [&](const Vec3& n_flush) { return by_edge || is_across(axis, n_flush); };
    if (on_a.flush >= 0 && counts(of_a(on_a.flush))) return {on_a.flush, -1};
    if (on_b.flush >= 0 && counts(of_b(on_b.flush))) return {-1, on_b.flush};
    if (by_edge) return {};
    return by_a ? Choice{on_a.face, -1} : Choice{-1, on_b.face};
}

}  // namespace

ContactPatch collide(const Polyhedron& a, const Pose& X_WA, const Polyhedron& b, const Pose& X_WB,
                     double margin, const Vec3& way_W) noexcept {
    ContactPatch patch;
    const Pose X_AB = X_WA.inverse() * X_WB;
    const Vec3 way_A = X_WA.R.conjugate() * way_W;
    const Vec3 way_B = X_WB.R.conjugate() * -way_W;
    const FaceQuery on_a = query_faces(a, b, X_AB, margin, way_A);
    if (on_a.separation > margin) return no_contact(on_a.separation);
    const FaceQuery on_b = query_faces(b, a, X_AB.inverse(), margin, way_B);
    if (on_b.separation > margin) return no_contact(on_b.separation);
    const EdgeQuery edges = query_edges(a, b, X_AB, margin);
    if (edges.separation > margin) return no_contact(edges.separation);

    const Choice choice = choose(a, b, X_AB, on_a, on_b, edges);
    if (choice.face_of_a >= 0) {
        face_contact(a, X_WA, choice.face_of_a, b, X_WB, margin, patch);
    } else if (choice.face_of_b >= 0) {
        face_contact(b, X_WB, choice.face_of_b, a, X_WA, margin, patch);
        flip(patch);
    } else {
        edge_contact(a, X_WA, b, X_AB, edges, patch);
    }
    if (is_covered(a, X_WA, patch.n_W) || is_covered(b, X_WB, -patch.n_W)) patch.count = 0;
    return patch;
}

ContactPatch collide_half_space(const Pose& X_WA, const Polyhedron& b, const Pose& X_WB,
                                double margin) noexcept {
    ContactPatch patch;
    patch.n_W = X_WA.R * Vec3::UnitZ();
    // all vertices within the margin form the patch, whatever their faces
    Polygon corners;
    for (const Vec3& vertex : b.vertices) corners.add(X_WB * vertex);
    keep_near(corners, patch.n_W.dot(X_WA.p), margin, patch);
    return patch;
}

}  // namespace dihaptic::dynamics
