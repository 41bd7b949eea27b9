#include "dynamics/round.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dynamics/patch.h"

namespace dihaptic::dynamics {
namespace {

/// A cap is treated as a polygon with this many corners. Its first corner is the lowest point of
/// the rim.
constexpr int kRim = 16;
/// Cosine of the largest angle (about 25 degrees) between the axis and the normal at which the
/// whole rim of a cap is used; at larger angles, only the lowest point of the rim is used.
constexpr double kCap = 0.9;
/// Limit below which lines count as parallel, and touch along their length.
constexpr double kParallel = 0.02;
/// Maximum number of projections in the search for closest points.
constexpr int kMostTurns = 60;
/// Room for the vertices of a polyhedron of up to 64 edges, in the world.
constexpr size_t kMostCorners = 64;
/// Closest points nearer to each other than this do not define a direction [m].
constexpr double kTogether = 1e-9;

/// The direction perpendicular to an axis that is nearest to d, or `otherwise` if d is parallel to
/// the axis.
Vec3 radial(const Vec3& axis, const Vec3& d, const Vec3& otherwise) {
    constexpr double kUpright = 1e-7;  // [rad], nanometres between the sides of a cap
    const Vec3 out = d - d.dot(axis) * axis;
    return out.norm() > kUpright ? Vec3(out.normalized()) : otherwise;
}

/// A round shape placed in the world.
struct Placed {
    const Round& shape;
    Vec3 centre;
    Vec3 axis;
    Vec3 across;  ///< perpendicular to the axis

    Placed(const Round& round, const Pose& X_W)
        : shape(round), centre(X_W.p), axis(X_W.R * Vec3::UnitZ()), across(X_W.R * Vec3::UnitX()) {}

    Vec3 end(double sign) const { return centre + sign * shape.half * axis; }
    /// Extent of the shape from its centre along the unit vector u.
    double extent(const Vec3& u) const {
        const double along = axis.dot(u);
        const double side = shape.has_rim() ? std::sqrt(std::max(0.0, 1 - along * along)) : 1;
        if (shape.is_cone())
            return std::max(shape.half * along, shape.radius * side - shape.half * along);
        return shape.half * std::abs(along) + shape.radius * side;
    }
    /// The direction perpendicular to the axis that is nearest to d.
    Vec3 radial(const Vec3& d) const { return dynamics::radial(axis, d, across); }
};

/// The closest points of two line segments p + s d and q + t e, with s and t between 0 and 1
/// (Ericson 2005).
std::pair<Vec3, Vec3> closest(const Vec3& p, const Vec3& d, const Vec3& q, const Vec3& e) {
    const Vec3 r = p - q;
    const double dd = d.squaredNorm(), ee = e.squaredNorm(), de = d.dot(e);
    const double det = dd * ee - de * de;
    const auto share = [](double a, double b) { return b > 0 ? std::clamp(a / b, 0.0, 1.0) : 0.0; };
    double s = det > 1e-12 * dd * ee ? share(de * e.dot(r) - ee * d.dot(r), det) : 0.5;
    const double t = share(e.dot(r) + s * de, ee);
    s = share(t * de - d.dot(r), dd);
    return {p + s * d, q + t * e};
}

/// The core of a cylinder or a cone: the shape shrunk by a given distance. If shapes touch, the
/// direction between their closest points is undefined, but between a core and another shape it is
/// not.
struct Core {
    double radius = 0;
    double low = 0, high = 0;  // ends along the axis
    bool has_tip = false;

    /// The core of a shape: the axis of a capsule or sphere; for other shapes, the shape shrunk by
    /// `rounding`.
    static Core of(const Round& shape, double rounding) {
        if (!shape.has_rim()) return {0, -shape.half, shape.half};
        const double half = shape.half - rounding;
        if (!shape.is_cone()) return {shape.radius - rounding, -half, half};
        // scale about the centre of the largest inscribed ball
        const double scale = 1 - rounding / inner_radius(shape);
        return {scale * shape.radius, -half, 2 * scale * shape.half - half, true};
    }
    /// Radius of the largest inscribed ball of a cylinder or cone.
    static double inner_radius(const Round& shape) {
        if (!shape.is_cone()) return std::min(shape.radius, shape.half);
        const double height = 2 * shape.half;
        return shape.radius * height / (shape.radius + std::hypot(shape.radius, height));
    }
    Vec3 nearest(const Placed& at, const Vec3& p) const {
        const Vec3 r = p - at.centre;
        const double along = r.dot(at.axis);
        Vec3 off = r - along * at.axis;
        if (has_tip && beyond_side(off.norm(), along)) return nearest_on_side(at, off, along);
        const double z = std::clamp(along, low, high);
        if (off.norm() > radius) off *= radius / off.norm();
        return at.centre + z * at.axis + off;
    }

  private:
    bool beyond_side(double across, double along) const {
        return (high - low) * across > radius * (high - along);
    }
    Vec3 nearest_on_side(const Placed& at, const Vec3& off, double along) const {
        const double height = high - low;
        const double across = off.norm();
        const double up = std::clamp((radius * (radius - across) + height * (along - low)) /
                                         (radius * radius + height * height),
                                     0.0, 1.0);
        return at.centre + (low + up * height) * at.axis + (1 - up) * radius * at.radial(off);
    }
};

double rounding_of(const Round& shape) {
    constexpr double kShare = 0.2;
    return shape.has_rim() ? kShare * Core::inner_radius(shape) : 0;
}

/// Finds the closest points of two convex sets by alternating projections (Cheney and Goldstein
/// 1959), starting from a point of the first set.
template <class NearestOfA, class NearestOfB>
std::pair<Vec3, Vec3> closest_by_turns(Vec3 p, int times, const NearestOfA& of_a,
                                       const NearestOfB& of_b) {
    Vec3 q = of_b(p);
    for (int i = 0; i < times; ++i) {
        const Vec3 next = of_a(q);
        const bool stays = (next - p).squaredNorm() < kTogether * kTogether;
        p = next;
        q = of_b(p);
        if (stays) break;
    }
    return {p, q};
}

/// Computes the polygon of the cap that faces along d.
void cap(const Placed& at, const Vec3& d, Polygon& out) {
    const double sign = at.axis.dot(d) < 0 ? -1 : 1;
    const Vec3 second = sign * at.axis.cross(at.across);
    out.count = 0;
    for (int i = 0; i < kRim; ++i) {
        const double angle = 2 * std::numbers::pi * i / kRim;
        out.add(at.end(sign) +
                at.shape.radius * (std::cos(angle) * at.across + std::sin(angle) * second));
    }
}

/// Finds the feature of a shape that is farthest along d. If `whole`, a cap that faces along d is
/// returned with its entire rim.
void feature(const Placed& at, const Vec3& d, bool whole, Polygon& out) {
    const Round& shape = at.shape;
    out.count = 0;
    if (!shape.has_rim()) {
        out.add(at.end(1) + shape.radius * d);
        if (shape.half > 0) out.add(at.end(-1) + shape.radius * d);
        return;
    }
    const double along = at.axis.dot(d);
    const double sign = along < 0 ? -1 : 1;
    const Vec3 first = at.radial(d);
    const Vec3 lowest = shape.radius * first;
    if (shape.is_cone() ? along > -kCap : std::abs(along) < kCap) {
        out.add(shape.is_cone() ? at.end(1) : Vec3(at.end(1) + lowest));
        out.add(at.end(-1) + lowest);
        return;
    }
    const Vec3 second = sign * at.axis.cross(first);
    for (int i = 0; i < (whole ? kRim : 1); ++i) {
        const double angle = 2 * std::numbers::pi * i / kRim;
        out.add(at.end(sign) + shape.radius * (std::cos(angle) * first + std::sin(angle) * second));
    }
}

/// For the nearest point of a patch, sets the point of the shape's rim that will touch in the
/// middle of a step in which the shape turns by turn_W. The patch's normal must point to the shape.
void look_ahead(const Placed& at, const Vec3& turn_W, ContactPatch& patch) {
    constexpr double kRolls = 0.9;  // cosine of the largest angle between the rim points
    constexpr double kLies = 1e-5;  // [m]: the shape lies on its side, touching along a line
    if (!at.shape.has_rim() || patch.count == 0) return;
    if (patch.count == 2 && std::abs(patch.points[0].gap - patch.points[1].gap) < kLies) return;
    const Quat half_way = rotation_by(turn_W / 2);
    const Vec3 d = -patch.n_W;
    const Vec3 now = at.radial(d);
    const Vec3 then = radial(half_way * at.axis, d, half_way * now);
    if ((half_way.conjugate() * then).dot(now) < kRolls) return;
    const auto nearest = std::min_element(
        patch.points.begin(), patch.points.begin() + patch.count,
        [](const ContactPoint& one, const ContactPoint& other) { return one.gap < other.gap; });
    const double along = at.axis.dot(nearest->p_WB - at.centre) > 0 ? 1 : -1;
    if (at.shape.is_cone() && along > 0) return;  // its tip
    nearest->ahead_W =
        at.shape.radius * (then - now) + along * at.shape.half * (half_way * at.axis - at.axis);
}

/// Clips a line from p to q to the half-space n . x <= offset.
void clip_line(const Vec3& n, double offset, Polygon& line) {
    Vec3& p = line.points[0];
    Vec3& q = line.points[1];
    const double dp = n.dot(p) - offset;
    const double dq = n.dot(q) - offset;
    if (dp > 0 && dq > 0) {
        line.count = 0;
    } else if (dp > 0) {
        p += dp / (dp - dq) * (q - p);
    } else if (dq > 0) {
        q += dq / (dq - dp) * (p - q);
    }
}

/// Finds the contacts of A's face, whose corners are counter-clockwise about the patch's normal,
/// with a feature of B.
void face_contact(const Polygon& face, const Polygon& of_b, double margin, ContactPatch& patch) {
    std::array<Polygon, 2> polygons;  // used alternately
    size_t current = 0;
    polygons[0] = of_b;
    for (size_t i = 0; i < face.count; ++i) {
        const Vec3& p = face.points[i];
        const Vec3 outward = (face.points[(i + 1) % face.count] - p).cross(patch.n_W);
        const double size = outward.norm();
        if (!(size > 0)) continue;
        const Vec3 n = outward / size;
        const double offset = n.dot(p);
        Polygon& polygon = polygons[current];
        if (polygon.count > 2) {
            clip(polygon, n, offset, polygons[1 - current]);
            current = 1 - current;
        } else if (polygon.count == 2) {
            clip_line(n, offset, polygon);
        } else if (polygon.count == 1 && n.dot(polygon.points[0]) > offset) {
            polygon.count = 0;
        }
    }
    keep_near(polygons[current], patch.n_W.dot(face.points[0]), margin, patch);
}

/// Reduces a line that is not perpendicular to u to its end that is farthest along u.
void keep_furthest(const Vec3& u, Polygon& line) {
    constexpr double kLevel = 1e-3;
    if (line.count != 2) return;
    const Vec3 d = line.points[1] - line.points[0];
    if (std::abs(u.dot(d)) <= kLevel * d.norm()) return;
    if (u.dot(d) > 0) line.points[0] = line.points[1];
    line.count = 1;
}

/// Finds the contacts between a point or line of each shape along the patch's normal; `gap` is the
/// smallest distance.
void line_contact(Polygon& of_a, Polygon& of_b, double gap, double margin, ContactPatch& patch) {
    patch.count = 0;
    const Vec3& n = patch.n_W;
    const auto add = [&](const Vec3& on_a, double apart) {
        if (apart > margin) return;
        patch.points[static_cast<size_t>(patch.count++)] = {on_a, on_a + apart * n, apart};
    };
    keep_furthest(n, of_a);
    keep_furthest(-n, of_b);
    const Vec3& p = of_a.points[0];
    const Vec3& q = of_b.points[0];
    if (of_a.count == 1) return add(p, gap);
    if (of_b.count == 1) return add(q - gap * n, gap);
    const Vec3 d = of_a.points[1] - p;
    const Vec3 e = of_b.points[1] - q;
    // the range in which they overlap lengthwise
    const double s_q = d.dot(q - p) / d.squaredNorm();
    const double s_e = d.dot(e) / d.squaredNorm();
    const double low = std::max(0.0, std::min(s_q, s_q + s_e));
    const double high = std::min(1.0, std::max(s_q, s_q + s_e));
    if (low >= high || d.cross(e).norm() > kParallel * d.norm() * e.norm())
        return add(closest(p, d, q, e).first, gap);
    for (const double s : {low, high}) add(p + s * d, n.dot(q + (s - s_q) / s_e * e - p - s * d));
}

/// The best separating axis so far, from A to B.
struct Best {
    enum Kind { face, cap_of_a, cap_of_b, line };
    double separation = -kInfinity;
    Vec3 axis = Vec3::Zero();
    Kind kind = line;
    int at = -1;  // the face

    double line_separation = -kInfinity;  // separation along the best line
    Vec3 line_axis = Vec3::Zero();

    void take(double sep, const Vec3& u, Kind k, int index = -1) {
        if (k == line && sep > line_separation) {
            line_separation = sep;
            line_axis = u;
        }
        // a face or cap is kept unless a line separates the shapes better by a margin
        const bool was_face = kind != line && k == line;
        if (sep <= separation + (was_face ? kFacePreference : 0)) return;
        separation = sep;
        axis = u;
        kind = k;
        at = index;
    }
};

/// How much farther the nearest point of a face's patch is than the closest feature along the
/// face's normal, which may lie beyond the sides of the face [m]. Zero if that feature meets the
/// face.
double missed(const ContactPatch& patch, double separation) {
    double least = kInfinity;
    for (int i = 0; i < patch.count; ++i)
        least = std::min(least, patch.points[static_cast<size_t>(i)].gap);
    return least - separation;
}

/// Whether the contact found on a face is that of the shapes. True only if the shapes are apart or
/// just touching and the face meets the closest feature; no other axis then separates the shapes
/// better.
bool settles(const ContactPatch& patch, double separation) {
    constexpr double kTouching = -1e-6;  // [m]
    return separation > kTouching && missed(patch, separation) < 1e-9;
}

/// Whether the distance between the shapes is given better by the best line than by the best face.
bool is_line(const Best& best, const ContactPatch& patch) {
    if (best.kind == Best::line) return true;
    if (best.line_axis.isZero(0)) return false;
    return missed(patch, best.separation) > best.separation - best.line_separation;
}

/// The surface normals on the side of a cylinder or a cone: around the axis, tilted up by the slope
/// of the side.
struct SideNormals {
    Vec3 first, second, up;

    explicit SideNormals(const Placed& of) {
        const double height = 2 * of.shape.half;
        const double lean = of.shape.is_cone() ? std::atan2(of.shape.radius, height) : 0;
        first = std::cos(lean) * of.across;
        second = std::cos(lean) * of.axis.cross(of.across);
        up = std::sin(lean) * of.axis;
    }
    Vec3 at(double angle) const { return std::cos(angle) * first + std::sin(angle) * second + up; }
    /// The angle at which the normal is nearest to u.
    double nearest(const Vec3& u) const { return std::atan2(second.dot(u), first.dot(u)); }
};

/// Tries the side normals of a shape, multiplied by `sign`, as axes. The distance as a function of
/// the axis has a ridge along these normals, and climb() does not follow this ridge to its top.
template <class Separation>
void walk_around(const Placed& of, double sign, const Separation& along, double margin,
                 Best& best) {
    constexpr int kWays = 16;
    constexpr int kMostTries = 80;
    constexpr double kShortest = 1e-9;  // [rad]
    if (!of.shape.has_rim() || best.separation > margin) return;
    const SideNormals normals(of);
    const auto there = [&](double angle) { return along(sign * normals.at(angle)); };
    const double start = normals.nearest(sign * best.line_axis);
    double stride = 2 * std::numbers::pi / kWays;
    double angle = start;
    double most = there(start);
    const auto look = [&](double other) {
        const double found = there(other);
        if (!(found > most)) return false;
        most = found;
        angle = other;
        return true;
    };
    for (int i = 1; i < kWays; ++i) look(start + i * stride);
    for (int n = 0; n < kMostTries && stride > kShortest; ++n)
        if (!look(angle + stride) && !look(angle - stride)) stride /= 2;
    best.take(most, sign * normals.at(angle), Best::line);
}

/// Distance between two round shapes, measured along the unit vector u.
double apart_along(const Placed& a, const Placed& b, const Vec3& u) {
    return u.dot(b.centre - a.centre) - a.extent(u) - b.extent(-u);
}

/// Tries a direction and its opposite as the axis between two round shapes.
void try_axis(const Placed& a, const Placed& b, Vec3 u, Best::Kind kind, Best& best) {
    const double size = u.norm();
    if (!(size > kTogether)) return;
    u /= size;
    if (u.dot(b.centre - a.centre) < 0) u = -u;
    best.take(apart_along(a, b, u), u, kind);
}

/// Tries the cap normals of one of two round shapes, if it has caps.
void try_caps(const Placed& a, const Placed& b, Best::Kind kind, Best& best) {
    const bool of_b = kind == Best::cap_of_b;
    const Placed& of = of_b ? b : a;
    if (!of.shape.has_rim()) return;
    if (!of.shape.is_cone()) return try_axis(a, b, of.axis, kind, best);
    const Vec3 u = of_b ? of.axis : Vec3(-of.axis);  // outward normal of the base
    best.take(apart_along(a, b, u), u, kind);
}

/// Climbs from the axis of the best line to the best axis near it, with shrinking strides in all
/// directions: the distance of convex shapes as a function of the axis has one peak, which may be a
/// ridge. Shapes that are farther apart than the margin need no better axis.
template <class Separation>
void climb(const Separation& along, double margin, Best& best) {
    constexpr int kWays = 7;
    constexpr int kMostTries = 60;
    constexpr double kLongest = 0.2, kShortest = 1e-6;
    const double enough = margin + kFacePreference;
    Vec3 u = best.line_axis;
    double most = best.line_separation;
    double turned = 0;
    double stride = kLongest;
    for (int n = 0; n < kMostTries && stride > kShortest && most <= enough; ++n) {
        const Vec3 e = u.unitOrthogonal();
        const Vec3 f = u.cross(e);
        Vec3 better = u;
        for (int i = 0; i < kWays; ++i) {
            const double angle = turned + 2 * std::numbers::pi * i / kWays;
            const Vec3 v = (u + stride * (std::cos(angle) * e + std::sin(angle) * f)).normalized();
            const double there = along(v);
            if (!(there > most)) continue;
            most = there;
            better = v;
        }
        if (better == u) {
            stride /= 2;
            turned += 1;  // makes sure that no ridge is missed between repeated directions
        }
        u = better;
    }
    best.take(most, u, Best::line);
}

/// The vertices and edges of a polyhedron placed in the world.
struct Corners {
    const Polyhedron& shape;
    const Pose& X_W;
    Vec3 vertex(int i) const { return X_W * shape.vertices[static_cast<size_t>(i)]; }

    /// The polyhedron's farthest extent along u.
    double furthest(const Vec3& u) const {
        const Vec3 d = X_W.R.conjugate() * u;
        double out = -kInfinity;
        for (const Vec3& v : shape.vertices) out = std::max(out, d.dot(v));
        return out + u.dot(X_W.p);
    }
    /// Finds the vertex or edge that is farthest along u.
    void feature(const Vec3& u, Polygon& out) const {
        constexpr double kLevel = 1e-5;  // [m]
        const double most = furthest(u);
        out.count = 0;
        for (const Vec3& v : shape.vertices) {
            const Vec3 p = X_W * v;
            if (u.dot(p) < most - kLevel) continue;
            if (out.count < 2) {
                out.add(p);
            } else if ((p - out.points[0]).norm() > (out.points[1] - out.points[0]).norm()) {
                out.points[1] = p;
            }
        }
    }
    void face(int i, Polygon& out) const {
        out.count = 0;
        for (const int v : shape.faces[static_cast<size_t>(i)].vertices) out.add(vertex(v));
    }
    /// Index of the face whose normal is closest to u.
    int towards(const Vec3& u) const {
        const Vec3 d = X_W.R.conjugate() * u;
        size_t best = 0;
        for (size_t f = 1; f < shape.faces.size(); ++f)
            if (shape.faces[f].normal.dot(d) > shape.faces[best].normal.dot(d)) best = f;
        return static_cast<int>(best);
    }
};

/// Tries the directions between the edges of `a` and the axis or rim of `b`.
void try_edges(const Corners& a, const Placed& b, double margin, Best& best) {
    const double rounding = rounding_of(b.shape);
    const Core core = Core::of(b.shape, rounding);
    const auto of_core = [&](const Vec3& p) { return core.nearest(b, p); };
    const Vec3 axis = b.end(1) - b.end(-1);
    double least = kInfinity;
    Vec3 on_a, on_b;
    const auto look = [&](const Vec3& p, const Vec3& d, int times) {
        std::pair<Vec3, Vec3> found = closest(p, d, b.end(-1), axis);
        if (core.radius > 0) {
            const auto of_edge = [&](const Vec3& q) {
                return Vec3(p + std::clamp(d.dot(q - p) / d.squaredNorm(), 0.0, 1.0) * d);
            };
            found = closest_by_turns(found.first, times, of_edge, of_core);
        }
        const double apart = (found.second - found.first).norm();
        if (apart >= least) return;
        least = apart;
        std::tie(on_a, on_b) = found;
    };
    const Polyhedron::Edge* nearest = nullptr;
    std::array<Vec3, kMostCorners> corners;  // each belongs to several edges
    const bool fit = a.shape.vertices.size() <= corners.size();
    for (size_t i = 0; fit && i < a.shape.vertices.size(); ++i)
        corners[i] = a.vertex(static_cast<int>(i));
    const auto corner = [&](int i) { return fit ? corners[static_cast<size_t>(i)] : a.vertex(i); };
    for (const Polyhedron::Edge& e : a.shape.edges) {
        const double before = least;
        look(corner(e.from), corner(e.to) - corner(e.from), 4);
        if (least < before) nearest = &e;
    }
    if (nearest == nullptr) return;
    if (core.radius > 0)
        look(corner(nearest->from), corner(nearest->to) - corner(nearest->from), kMostTurns);
    const auto along = [&](const Vec3& u) {
        return u.dot(b.centre) - b.extent(-u) - a.furthest(u);
    };
    // if the edge passes through the core, climb from the best axis so far
    const Vec3 u = least > kTogether ? Vec3((on_b - on_a) / least) : best.axis;
    best.take(along(u), u, Best::line);
    if (core.radius > 0) climb(along, margin, best);
    if (b.shape.is_cone()) walk_around(b, -1, along, margin, best);
}

/// Finds the contacts of a cap, if the best axis is that of a cap.
void cap_contact(const Placed& a, const Placed& b, const Best& best, double margin,
                 ContactPatch& patch) {
    const bool of_b = best.kind == Best::cap_of_b;
    Polygon face;
    Polygon met;
    patch.n_W = of_b ? Vec3(-best.axis) : best.axis;
    cap(of_b ? b : a, patch.n_W, face);
    feature(of_b ? a : b, -patch.n_W, true, met);
    face_contact(face, met, margin, patch);
    if (of_b) flip(patch);
}

/// Tries the directions between two round shapes, except for the cap normals.
void try_lines(const Placed& a, const Placed& b, double margin, Best& best) {
    const auto [on_a, on_b] =
        closest(a.end(-1), a.end(1) - a.end(-1), b.end(-1), b.end(1) - b.end(-1));
    try_axis(a, b, on_b - on_a, Best::line, best);
    if (a.shape.has_rim() || b.shape.has_rim()) {
        try_axis(a, b, a.axis.cross(b.axis), Best::line, best);
        if (best.separation > margin) return;
        const bool sharp = !(a.shape.has_rim() && b.shape.has_rim());
        const Core core_a = Core::of(a.shape, sharp ? 0 : rounding_of(a.shape));
        const Core core_b = Core::of(b.shape, sharp ? 0 : rounding_of(b.shape));
        const auto [p, q] = closest_by_turns(
            on_a, kMostTurns, [&](const Vec3& x) { return core_a.nearest(a, x); },
            [&](const Vec3& x) { return core_b.nearest(b, x); });
        try_axis(a, b, q - p, Best::line, best);
        const auto along = [&](const Vec3& u) { return apart_along(a, b, u); };
        if (!best.line_axis.isZero(0)) climb(along, margin, best);
        if (a.shape.is_cone() || b.shape.is_cone()) {
            walk_around(a, 1, along, margin, best);
            walk_around(b, -1, along, margin, best);
        }
    }
    if (best.axis.isZero(0))  // one shape is inside the other
        best.take(-a.extent(a.across) - b.extent(a.across), a.across, Best::line);
}

/// Returns the best of the faces of `a` and the caps of `b`. Sets `flush` to the face of `a` with
/// which `b` is flush, or to -1 if there is none.
Best best_face(const Corners& a, const Placed& b, double margin, const Vec3& way_W, int& flush) {
    Best best;
    flush = -1;
    for (size_t f = 0; f < a.shape.faces.size(); ++f) {
        const Vec3 n = a.X_W.R * a.shape.faces[f].normal;
        const double separation =
            n.dot(b.centre - a.X_W.p) - b.extent(-n) - a.shape.faces[f].offset;
        best.take(separation, n, Best::face, static_cast<int>(f));
        if (separation > margin) return best;
        if (is_flush(separation, n, way_W)) flush = static_cast<int>(f);
    }
    if (!b.shape.has_rim()) return best;
    for (const double sign : {1.0, -1.0}) {
        if (b.shape.is_cone() && sign < 0) break;  // a cone has its tip at this end, not a cap
        const Vec3 u = sign * b.axis;
        best.take(u.dot(b.centre) - b.shape.half - a.furthest(u), u, Best::cap_of_b);
    }
    return best;
}

/// Finds the contacts of the best face or cap.
void face_contact(const Corners& a, const Placed& b, const Best& best, double margin,
                  ContactPatch& patch) {
    Polygon of_a;
    Polygon of_b;
    if (best.kind == Best::face) {
        patch.n_W = best.axis;
        a.face(best.at, of_a);
        feature(b, -best.axis, true, of_b);
        face_contact(of_a, of_b, margin, patch);
    } else {
        patch.n_W = -best.axis;
        cap(b, patch.n_W, of_b);
        a.face(a.towards(best.axis), of_a);
        face_contact(of_b, of_a, margin, patch);
        flip(patch);
    }
}

}  // namespace

ContactPatch collide_half_space(const Pose& X_WA, const Round& shape_b, const Pose& X_WB,
                                double margin, const Vec3& turn_W) noexcept {
    ContactPatch patch;
    patch.n_W = X_WA.R * Vec3::UnitZ();
    const Placed b(shape_b, X_WB);
    Polygon of_b;
    feature(b, -patch.n_W, true, of_b);
    keep_near(of_b, patch.n_W.dot(X_WA.p), margin, patch);
    look_ahead(b, turn_W, patch);
    return patch;
}

ContactPatch collide(const Round& shape_a, const Pose& X_WA, const Round& shape_b, const Pose& X_WB,
                     double margin) noexcept {
    ContactPatch patch;
    const Placed a(shape_a, X_WA);
    const Placed b(shape_b, X_WB);
    Best best;
    try_caps(a, b, Best::cap_of_a, best);
    try_caps(a, b, Best::cap_of_b, best);
    if (best.separation > margin) return no_contact(best.separation);
    if (best.kind != Best::line) cap_contact(a, b, best, margin, patch);
    if (settles(patch, best.separation)) return patch;
    try_lines(a, b, margin, best);
    if (best.separation > margin) return no_contact(best.separation);
    if (!is_line(best, patch)) return patch;
    Polygon of_a;
    Polygon of_b;
    patch.n_W = best.line_axis;
    feature(a, patch.n_W, false, of_a);
    feature(b, -patch.n_W, false, of_b);
    line_contact(of_a, of_b, best.line_separation, margin, patch);
    return patch;
}

ContactPatch collide(const Polyhedron& shape_a, const Pose& X_WA, const Round& shape_b,
                     const Pose& X_WB, double margin, const Vec3& way_W,
                     const Vec3& turn_W) noexcept {
    ContactPatch patch;
    const Corners a{shape_a, X_WA};
    const Placed b(shape_b, X_WB);
    int flush = -1;
    Best best = best_face(a, b, margin, way_W, flush);
    if (best.separation > margin) return no_contact(best.separation);
    const Vec3 n_flush =
        flush < 0 ? best.axis : Vec3(X_WA.R * shape_a.faces[static_cast<size_t>(flush)].normal);
    if (flush >= 0 && (best.at == flush || is_across(best.axis, n_flush))) {
        best.kind = Best::face;
        best.at = flush;
        best.axis = n_flush;
        if (is_covered(shape_a, X_WA, n_flush)) return patch;
        face_contact(a, b, best, margin, patch);
        look_ahead(b, turn_W, patch);
        return patch;
    }
    face_contact(a, b, best, margin, patch);
    if (best.kind == Best::face) look_ahead(b, turn_W, patch);
    if (!settles(patch, best.separation)) {
        try_edges(a, b, margin, best);
        if (best.separation > margin) return no_contact(best.separation);
        if (flush >= 0 && best.kind == Best::line) return {};
        if (is_line(best, patch)) {
            Polygon of_a;
            Polygon of_b;
            patch.n_W = best.line_axis;
            a.feature(patch.n_W, of_a);
            feature(b, -patch.n_W, false, of_b);
            line_contact(of_a, of_b, best.line_separation, margin, patch);
        }
    }
    if (is_covered(shape_a, X_WA, patch.n_W)) return {};
    return patch;
}

}  // namespace dihaptic::dynamics
