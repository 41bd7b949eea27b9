#include "view/triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "view/colours.h"

namespace dihaptic::view {
namespace {

using std::numbers::pi;
constexpr int kRound = 48;             // number of segments of a full circle
constexpr int kBevel = 3;              // number of segments of half a rounded edge
constexpr double kMostBevel = 1.2e-3;  // largest radius of a rounded edge [m]
/// If the angle between two faces of a mesh is smaller than this, they are shaded as one smooth
/// surface.
const double kSmooth = std::cos(40 * pi / 180);

double bevel(double smallest_edge) {
    return std::min(kMostBevel, 0.05 * smallest_edge);
}

uint32_t add(Triangles& out, const Vec3& p, const Vec3& n) {
    out.vertices.push_back({p.cast<float>(), n.cast<float>()});
    return static_cast<uint32_t>(out.vertices.size() - 1);
}

/// Adds two triangles for each cell of a grid of vertices.
void add_grid(Triangles& out, uint32_t first, uint32_t rows, uint32_t columns) {
    for (uint32_t i = 0; i + 1 < rows; ++i) {
        for (uint32_t j = 0; j + 1 < columns; ++j) {
            const uint32_t a = first + i * columns + j;
            const uint32_t b = a + columns;
            out.indices.insert(out.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
        }
    }
}

/// A rounded box is a core, smaller than the box by the bevel r, plus a sphere of radius r rolled
/// over the core. A point q of the sharp box at core + r tan(angle) is moved to the sphere about
/// the nearest point of the core.
Triangles box(const Vec3& size) {
    const double r = bevel(size.minCoeff());
    const Vec3 core = size / 2 - Vec3::Constant(r);
    // offsets from the core, in units of r; negative on the low side
    std::array<double, 2 * (kBevel + 1)> steps{};
    for (int i = 0; i <= kBevel; ++i) {
        const double out = std::tan(pi / 4 * i / kBevel);
        steps[static_cast<size_t>(kBevel - i)] = -out;
        steps[static_cast<size_t>(kBevel + 1 + i)] = out;
    }
    Triangles out;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        for (const double side : {-1.0, 1.0}) {
            const auto first = static_cast<uint32_t>(out.vertices.size());
            for (size_t i = 0; i < steps.size(); ++i) {
                for (size_t j = 0; j < steps.size(); ++j) {
                    // on the low side, the grid runs the other way round, so that it faces outward
                    const size_t k = side > 0 ? j : steps.size() - 1 - j;
                    const double low_u = 2 * i < steps.size() ? -1 : 1;
                    const double low_v = 2 * k < steps.size() ? -1 : 1;
                    Vec3 inner;
                    inner[axis] = side * core[axis];
                    inner[u] = low_u * core[u];
                    inner[v] = low_v * core[v];
                    Vec3 n;
                    n[axis] = side;
                    n[u] = steps[i];
                    n[v] = steps[k];
                    n.normalize();
                    add(out, inner + r * n, n);
                }
            }
            const auto count = static_cast<uint32_t>(steps.size());
            const size_t before = out.indices.size();
            add_grid(out, first, count, count);
            for (size_t t = before; t < out.indices.size(); t += 3)
                std::swap(out.indices[t + 1], out.indices[t + 2]);
        }
    }
    return out;
}

/// A point of a profile, given by radius and z, and the outward normal at this point.
struct Profile {
    double r, z, n_r, n_z;
};

/// The surface made by rotating a profile, given from bottom to top, about the z axis.
Triangles lathe(std::span<const Profile> profile) {
    Triangles out;
    for (const Profile& at : profile) {
        for (int j = 0; j <= kRound; ++j) {
            const double angle = 2 * pi * j / kRound;
            const double c = std::cos(angle);
            const double s = std::sin(angle);
            add(out, {at.r * c, at.r * s, at.z}, {at.n_r * c, at.n_r * s, at.n_z});
        }
    }
    add_grid(out, 0, static_cast<uint32_t>(profile.size()), kRound + 1);
    return out;
}

void add_arc(std::vector<Profile>& profile, double r, double z, double radius, double from,
             double to, int segments) {
    for (int i = 0; i <= segments; ++i) {
        const double angle = from + (to - from) * i / segments;
        const double c = std::cos(angle);
        const double s = std::sin(angle);
        profile.push_back({r + radius * c, z + radius * s, c, s});
    }
}

/// A capsule, i.e. a cylinder between two half-spheres; a sphere if `length` is 0.
Triangles capsule(double radius, double length) {
    std::vector<Profile> profile;
    add_arc(profile, 0, -length / 2, radius, -pi / 2, 0, kRound / 4);
    add_arc(profile, 0, length / 2, radius, 0, pi / 2, kRound / 4);
    return lathe(profile);
}

Triangles cylinder(double radius, double length) {
    const double b = bevel(std::min(2 * radius, length));
    std::vector<Profile> profile{{0, -length / 2, 0, -1}};
    add_arc(profile, radius - b, -length / 2 + b, b, -pi / 2, 0, 2 * kBevel);
    add_arc(profile, radius - b, length / 2 - b, b, 0, pi / 2, 2 * kBevel);
    profile.push_back({0, length / 2, 0, 1});
    return lathe(profile);
}

Triangles cone(double radius, double length) {
    const double b = bevel(std::min(2 * radius, length));
    const double lean = std::atan2(radius, length);
    // radius at which the rounded edge is as far from the side as from the base
    const double r = ((length - b) * std::sin(lean) - b) / std::cos(lean);
    std::vector<Profile> profile{{0, -length / 2, 0, -1}};
    add_arc(profile, r, -length / 2 + b, b, -pi / 2, lean, 2 * kBevel);
    profile.push_back({0, length / 2, std::cos(lean), std::sin(lean)});
    return lathe(profile);
}

/// At each corner of a face, the normal is the area-weighted mean over those faces at the corner
/// that are nearly parallel to this face.
Triangles polyhedron(std::span<const Vec3> vertices, std::span<const std::vector<int>> faces) {
    struct At {
        Vec3 area;
        Vec3 n;
    };
    const auto key = [&](int v) {
        const Vec3& p = vertices[static_cast<size_t>(v)];
        return std::array{p.x(), p.y(), p.z()};
    };
    std::map<std::array<double, 3>, std::vector<At>> around;
    std::vector<Vec3> normals;
    for (const std::vector<int>& face : faces) {
        Vec3 area = Vec3::Zero();
        const Vec3& a = vertices[static_cast<size_t>(face[0])];
        for (size_t i = 1; i + 1 < face.size(); ++i)
            area += (vertices[static_cast<size_t>(face[i])] - a)
                        .cross(vertices[static_cast<size_t>(face[i + 1])] - a);
        normals.push_back(area.normalized());
        for (const int v : face) around[key(v)].push_back({area, normals.back()});
    }
    Triangles out;
    for (size_t f = 0; f < faces.size(); ++f) {
        const auto first = static_cast<uint32_t>(out.vertices.size());
        for (const int v : faces[f]) {
            Vec3 n = Vec3::Zero();
            for (const At& at : around[key(v)]) {
                if (at.n.dot(normals[f]) > kSmooth) n += at.area;
            }
            add(out, vertices[static_cast<size_t>(v)],
                n.norm() > 0 ? Vec3(n.normalized()) : normals[f]);
        }
        for (uint32_t i = 1; i + 1 < faces[f].size(); ++i)
            out.indices.insert(out.indices.end(), {first, first + i, first + i + 1});
    }
    return out;
}

const Eigen::Vector3f kNoColour =
    Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());

Triangles coloured(const scene::Mesh& mesh) {
    Triangles out = polyhedron(mesh.vertices, mesh.faces);
    if (mesh.colours.empty()) return out;
    // every corner of every face is a separate vertex
    for (const std::vector<int>& face : mesh.faces) {
        for (const int v : face) {
            const int32_t rgb = mesh.colours[static_cast<size_t>(v)];
            out.colours.push_back(
                rgb < 0 ? kNoColour
                        : linear_colour(static_cast<uint32_t>(rgb)).cast<float>().eval());
        }
    }
    return out;
}

}  // namespace

void Triangles::append(const Triangles& other, const Pose& X) {
    const auto offset = static_cast<uint32_t>(vertices.size());
    if (!colours.empty() || !other.colours.empty()) {
        colours.resize(vertices.size(), kNoColour);
        colours.insert(colours.end(), other.colours.begin(), other.colours.end());
        colours.resize(vertices.size() + other.vertices.size(), kNoColour);
    }
    for (const Vertex& v : other.vertices) {
        vertices.push_back(
            {(X * v.p.cast<double>()).cast<float>(), (X.R * v.n.cast<double>()).cast<float>()});
    }
    for (const uint32_t i : other.indices) indices.push_back(offset + i);
}

Triangles triangles(const scene::Shape& shape, double plane_size) {
    switch (shape.kind) {
        case scene::ShapeKind::box:
            return box(shape.size);
        case scene::ShapeKind::sphere:
            return capsule(shape.radius, 0);
        case scene::ShapeKind::capsule:
            return capsule(shape.radius, shape.length);
        case scene::ShapeKind::cylinder:
            return cylinder(shape.radius, shape.length);
        case scene::ShapeKind::cone:
            return cone(shape.radius, shape.length);
        case scene::ShapeKind::plane:
            return square(plane_size);
        case scene::ShapeKind::mesh:
            if (shape.coloured) return coloured(*shape.coloured);
            return shape.concave ? polyhedron(shape.surface.vertices, shape.surface.faces)
                                 : polyhedron(shape.hull.vertices, shape.hull.faces);
        case scene::ShapeKind::compound: {
            Triangles out;
            for (const scene::Part& part : shape.parts)
                out.append(triangles(part.shape), part.pose());
            return out;
        }
    }
    return {};
}

Triangles triangles(const scene::Body& body, double plane_size) {
    if (body.seen && body.seen->mesh) return coloured(*body.seen->mesh);
    return triangles(body.shape, plane_size);
}

Triangles square(double size) {
    Triangles out;
    const double h = size / 2;
    for (const Vec3& p : {Vec3(-h, -h, 0), Vec3(h, -h, 0), Vec3(h, h, 0), Vec3(-h, h, 0)})
        add(out, p, Vec3::UnitZ());
    out.indices = {0, 1, 2, 0, 2, 3};
    return out;
}

Triangles tube(std::span<const Vec3> path, double radius) {
    std::vector<Vec3> points;
    for (const Vec3& p : path) {
        if (p.allFinite() && (points.empty() || (p - points.back()).norm() > radius / 4))
            points.push_back(p);
    }
    Triangles out;
    if (points.size() < 2) return out;
    constexpr int kSides = 12;
    Vec3 across = (points[1] - points[0]).unitOrthogonal();
    const auto ring = [&](const Vec3& p, const Vec3& along, double r, double n_along) {
        const double n_across = std::sqrt(1 - n_along * n_along);
        const Vec3 other = along.cross(across);
        for (int j = 0; j <= kSides; ++j) {
            const double angle = 2 * pi * j / kSides;
            const Vec3 out_w = std::cos(angle) * across + std::sin(angle) * other;
            add(out, p + r * out_w, n_across * out_w + n_along * along);
        }
    };
    uint32_t rings = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        const Vec3& before = points[i > 0 ? i - 1 : 0];
        const Vec3& after = points[std::min(i + 1, points.size() - 1)];
        Vec3 along = after - before;
        if (along.norm() < 1e-9) along = points[i] - before;  // here, the path turns back on itself
        along.normalize();
        // `across` is moved along the path without twisting
        across -= across.dot(along) * along;
        across = across.norm() > 1e-6 ? Vec3(across.normalized()) : along.unitOrthogonal();
        const auto cap = [&](double side) {
            for (int k = 0; k < kBevel; ++k) {
                const double up = side < 0 ? kBevel - k : k + 1;
                const double angle = pi / 2 * up / kBevel;
                ring(points[i] + side * radius * std::sin(angle) * along, along,
                     radius * std::cos(angle), side * std::sin(angle));
                ++rings;
            }
        };
        if (i == 0) cap(-1);
        ring(points[i], along, radius, 0);
        ++rings;
        if (i + 1 == points.size()) cap(1);
    }
    add_grid(out, 0, rings, kSides + 1);
    return out;
}

Triangles arrow(double length, double radius) {
    const double head = std::min(6 * radius, 0.6 * length);
    const double neck = length - head;
    const double slope = std::hypot(head, 2.5 * radius);
    const double n_r = head / slope;
    const double n_z = 2.5 * radius / slope;
    const std::array<Profile, 8> profile{{{0, 0, 0, -1},
                                          {radius, 0, 0, -1},
                                          {radius, 0, 1, 0},
                                          {radius, neck, 1, 0},
                                          {radius, neck, 0, -1},
                                          {2.5 * radius, neck, 0, -1},
                                          {2.5 * radius, neck, n_r, n_z},
                                          {0, length, n_r, n_z}}};
    return lathe(profile);
}

}  // namespace dihaptic::view
