#include "scene/closed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "scene/hull.h"
#include "scene/mend.h"

namespace dihaptic::scene {
namespace {

/// Disjoint sets that can be united.
class Sets {
  public:
    explicit Sets(size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), size_t{0});
    }
    size_t of(size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(size_t a, size_t b) { parent_[std::max(of(a), of(b))] = std::min(of(a), of(b)); }

  private:
    std::vector<size_t> parent_;
};

/// A face next to an edge. The edge runs from corner `first` of the face to the next corner.
struct EdgeSide {
    size_t face = 0;
    size_t first = 0;
    bool is_forward = false;  ///< whether it runs from the edge's smaller vertex to its larger one
    double angle = 0;         ///< angle of the face about the edge [rad]
};

using Sides = std::map<Edge, std::vector<EdgeSide>>;

Sides sides_of(const Mesh& mesh) {
    Sides out;
    for (size_t i = 0; i < mesh.faces.size(); ++i) {
        const std::vector<int>& f = mesh.faces[i];
        for (size_t k = 0; k < 3; ++k) {
            const int a = f[k];
            const int b = f[(k + 1) % 3];
            out[std::minmax(a, b)].push_back({i, k, a < b, 0});
        }
    }
    return out;
}

/// At an edge with more than two faces, returns the pairs of faces that bound the same wedge of
/// solid. In order of angle about the edge, each face that starts a wedge is paired with the first
/// unpaired face that ends a wedge.
std::vector<std::pair<EdgeSide, EdgeSide>> wedges(const Mesh& mesh, const Edge& edge,
                                                  std::vector<EdgeSide> sides) {
    const Vec3 along = (corner(mesh, edge.second) - corner(mesh, edge.first)).normalized();
    const Vec3 x = along.unitOrthogonal();
    for (EdgeSide& side : sides) {
        const int third = mesh.faces[side.face][(side.first + 2) % 3];
        const Vec3 out = corner(mesh, third) - corner(mesh, edge.first);
        side.angle = std::atan2(out.dot(along.cross(x)), out.dot(x));
    }
    std::stable_sort(sides.begin(), sides.end(),
                     [](const EdgeSide& a, const EdgeSide& b) { return a.angle < b.angle; });
    // start at an angle at which no wedge is open
    int open = 0;
    int least = 0;
    size_t start = 0;
    for (size_t i = 0; i < sides.size(); ++i) {
        open += sides[i].is_forward ? -1 : 1;
        if (open >= least) continue;
        least = open;
        start = i + 1;
    }
    std::rotate(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(start % sides.size()),
                sides.end());
    std::vector<EdgeSide> begun;
    std::vector<std::pair<EdgeSide, EdgeSide>> out;
    for (const EdgeSide& side : sides) {
        if (!side.is_forward) {
            begun.push_back(side);
        } else {
            out.emplace_back(begun[out.size()], side);
        }
    }
    return out;
}

/// Gives each sheet of the surface its own vertices where several sheets meet at a vertex or an
/// edge, and finds the shells.
std::vector<Shell> separate(Mesh& mesh) {
    Sets corners(3 * mesh.faces.size());
    Sets faces(mesh.faces.size());
    const auto join = [&](const EdgeSide& a, const EdgeSide& b) {
        faces.join(a.face, b.face);
        corners.join(3 * a.face + a.first, 3 * b.face + (b.first + 1) % 3);
        corners.join(3 * a.face + (a.first + 1) % 3, 3 * b.face + b.first);
    };
    for (const auto& [edge, sides] : sides_of(mesh)) {
        if (sides.size() == 2) {
            join(sides[0], sides[1]);
        } else {
            for (const auto& [a, b] : wedges(mesh, edge, sides)) join(a, b);
        }
    }
    std::map<size_t, int> vertex;  // the vertex for each set of corners
    std::vector<bool> is_taken(mesh.vertices.size());
    std::map<size_t, size_t> number;  // the shell's number for each set of faces
    std::vector<Shell> shells;
    for (size_t i = 0; i < mesh.faces.size(); ++i) {
        for (size_t k = 0; k < 3; ++k) {
            int& at = mesh.faces[i][k];
            const auto [known, is_new] = vertex.try_emplace(corners.of(3 * i + k), at);
            if (is_new && is_taken[static_cast<size_t>(at)]) {
                known->second = static_cast<int>(mesh.vertices.size());
                mesh.vertices.push_back(Vec3(corner(mesh, at)));
            } else if (is_new) {
                is_taken[static_cast<size_t>(at)] = true;
            }
            at = known->second;
        }
        const auto [known, is_new] = number.try_emplace(faces.of(i), shells.size());
        if (is_new) shells.emplace_back();
        shells[known->second].faces.push_back(i);
    }
    return shells;
}

/// The winding number of a shell around a point (Van Oosterom and Strackee 1983). It is a fraction
/// if the point is on the surface.
double winding(const Mesh& mesh, const Shell& shell, const Vec3& p) {
    double angle = 0;
    for (const size_t i : shell.faces) {
        const std::vector<int>& f = mesh.faces[i];
        const Vec3 a = corner(mesh, f[0]) - p;
        const Vec3 b = corner(mesh, f[1]) - p;
        const Vec3 c = corner(mesh, f[2]) - p;
        const double la = a.norm();
        const double lb = b.norm();
        const double lc = c.norm();
        angle += 2 * std::atan2(a.dot(b.cross(c)),
                                la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return angle / (4 * M_PI);
}

/// Data on a shell that are needed for sorting.
struct Nested {
    double volume = 0;
    Vec3 low;
    Vec3 high;
    std::vector<size_t> around;  ///< the shells that contain this shell, smallest first
};

Nested look_at(const Mesh& mesh, const Shell& shell) {
    Nested out;
    std::vector<std::vector<int>> faces;
    out.low = out.high = corner(mesh, mesh.faces[shell.faces.front()][0]);
    for (const size_t i : shell.faces) {
        faces.push_back(mesh.faces[i]);
        for (const int v : faces.back()) {
            out.low = out.low.cwiseMin(corner(mesh, v));
            out.high = out.high.cwiseMax(corner(mesh, v));
        }
    }
    out.volume = integrate(mesh.vertices, faces).volume;
    return out;
}

/// Whether one shell lies within another, apart from points at which the two touch.
bool is_in(const Mesh& mesh, const Shell& inner, const Nested& small, const Shell& outer,
           const Nested& large) {
    if (std::abs(small.volume) >= std::abs(large.volume)) return false;
    const Vec3 room = Vec3::Constant(1e-9 * (large.high - large.low).norm());
    if ((small.low.array() < (large.low - room).array()).any() ||
        (small.high.array() > (large.high + room).array()).any())
        return false;
    constexpr size_t kMost = 300;  // number of faces that are tested, evenly spread over the shell
    const size_t step = inner.faces.size() / kMost + 1;
    for (size_t i = 0; i < inner.faces.size(); i += step) {
        const std::vector<int>& f = mesh.faces[inner.faces[i]];
        const Vec3 middle = (corner(mesh, f[0]) + corner(mesh, f[1]) + corner(mesh, f[2])) / 3;
        // the winding number is 1/8 at the corner of a box that touches the shell from inside
        for (const Vec3& p : {corner(mesh, f[0]), middle}) {
            if (std::abs(winding(mesh, outer, p)) < 0.01) return false;
        }
    }
    return true;
}

/// The nesting of shells, and the side that their faces face.
class Nesting {
  public:
    explicit Nesting(ClosedMesh& solid) : solid_(solid) {
        for (const Shell& shell : solid.shells) all_.push_back(look_at(solid.mesh, shell));
        for (size_t i = 0; i < all_.size(); ++i) all_[i].around = around(i);
    }
    /// Reverses shells whose faces point into the solid, and finds the solid that contains each
    /// cavity. Returns the number of reversed shells, or 0 if merely the whole mesh was inside out.
    size_t sort_out() {
        std::vector<size_t> order(all_.size());
        std::iota(order.begin(), order.end(), size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
            return all_[a].around.size() < all_[b].around.size();
        });
        for (const size_t i : order) {
            if (all_[i].around.empty()) {
                face_outermost(i);
            } else if (all_[i].volume < 0) {
                face_inner(i);
            }
        }
        return any_right_ ? turned_ : 0;
    }

  private:
    std::vector<size_t> around(size_t i) const {
        std::vector<size_t> out;
        for (size_t k = 0; k < all_.size(); ++k) {
            if (i != k && is_in(solid_.mesh, solid_.shells[i], all_[i], solid_.shells[k], all_[k]))
                out.push_back(k);
        }
        std::sort(out.begin(), out.end(), [&](size_t a, size_t b) {
            return std::abs(all_[a].volume) < std::abs(all_[b].volume);
        });
        return out;
    }
    void turn_around(size_t i) {
        for (const size_t f : solid_.shells[i].faces)
            std::swap(solid_.mesh.faces[f][1], solid_.mesh.faces[f][2]);
        all_[i].volume *= -1;
    }
    /// Corrects the orientation of an outermost shell. If it has to be reversed, the shells inside
    /// it are reversed as well.
    void face_outermost(size_t i) {
        any_right_ |= all_[i].volume > 0;
        if (all_[i].volume > 0) return;
        ++turned_;
        turn_around(i);
        for (size_t k = 0; k < all_.size(); ++k) {
            if (!all_[k].around.empty() && all_[k].around.back() == i) turn_around(k);
        }
    }
    /// Treats a shell whose faces point inward. It is a cavity in the smallest solid around it; if
    /// there is no solid around it, it lies in a cavity and is reversed.
    void face_inner(size_t i) {
        int depth = 0;
        int within = -1;
        for (const size_t k : all_[i].around) {
            depth += all_[k].volume > 0 ? 1 : -1;
            if (all_[k].volume > 0 && within < 0) within = static_cast<int>(k);
        }
        if (depth > 0) {
            solid_.shells[i].within = within;
            return;
        }
        turn_around(i);
        any_right_ = true;
        ++turned_;
    }

    ClosedMesh& solid_;
    std::vector<Nested> all_;
    size_t turned_ = 0;
    bool any_right_ = false;
};

/// Number of edges that do not join two faces of the same orientation.
size_t count_faulty(const Mesh& mesh) {
    std::map<Edge, int> edges;
    for (const std::vector<int>& f : mesh.faces) {
        for (size_t i = 0; i < 3; ++i) ++edges[{f[i], f[(i + 1) % 3]}];
    }
    return static_cast<size_t>(std::count_if(edges.begin(), edges.end(), [&](const auto& edge) {
        const auto back = edges.find({edge.first.second, edge.first.first});
        return edge.second != 1 || back == edges.end() || back->second != 1;
    }));
}

/// Description of the fault at an unbalanced edge.
std::string fault_at(const Mesh& mesh, const Edge& edge) {
    size_t forward = 0;
    size_t back = 0;
    for (const std::vector<int>& f : mesh.faces) {
        for (size_t i = 0; i < 3; ++i) {
            const Edge one{f[i], f[(i + 1) % 3]};
            forward += one == edge;
            back += one == Edge{edge.second, edge.first};
        }
    }
    if (forward == 1 && back == 0) return "where one face has no neighbour";
    if (forward == 2 && back == 0) return "where two faces face opposite ways";
    return fmt::format("where {} faces meet", forward + back);
}

/// Distance between a point and an edge, including the ends of the edge.
double distance(const Mesh& mesh, int point, const Edge& edge) {
    const Vec3& a = corner(mesh, edge.first);
    const Vec3 along = corner(mesh, edge.second) - a;
    const Vec3 p = corner(mesh, point) - a;
    const double share = std::clamp(p.dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - share * along).norm();
}

/// Describes a corner that lies near an edge but is not one of its ends, if the two were probably
/// meant to meet; "" if there is none.
std::string near_miss(const Mesh& mesh, const std::map<Edge, int>& open, double rounding,
                      const MeshName& name) {
    std::set<int> ends;
    for (const auto& [edge, count] : open) ends.insert({edge.first, edge.second});
    int nearest = -1;
    double gap = 1000 * rounding;
    constexpr size_t kMost = 3000;  // limit on the corners, because all pairs are examined
    for (const auto& [edge, count] : open) {
        if (open.size() > kMost) break;
        for (const int end : ends) {
            if (end == edge.first || end == edge.second) continue;
            const double away = distance(mesh, end, edge);
            if (away >= gap) continue;
            gap = away;
            nearest = end;
        }
    }
    if (nearest < 0) return "";
    return fmt::format(
        "; its corner at {} is {:.2g} {} from another edge, where up to {:.2g} {} count as "
        "rounding",
        name.place(corner(mesh, nearest)), gap / name.unit, name.word, rounding / name.unit,
        name.word);
}

/// Returns the error for a mesh that is still open after mending.
Error not_closed(const Mesh& mesh, const Mesh& best, double rounding, const MeshName& name) {
    const std::map<Edge, int> open = open_edges(best);
    const Edge& first = open.begin()->first;
    const std::string miss = near_miss(best, open, rounding, name);
    return name.refused(
        fmt::format("is not closed: {} of its edges do not join two faces of the same "
                    "orientation, the first from {} to {}, {}{}",
                    count_faulty(mesh), name.place(corner(best, first.first)),
                    name.place(corner(best, first.second)), fault_at(best, first), miss),
        miss.empty() ? "Close its holes, orient its faces alike and delete duplicate "
                       "faces in a mesh editor, or leave out 'concave'."
                     : "Merge nearby corners in a mesh editor, or leave out 'concave'.");
}

}  // namespace

std::string MeshName::place(const Vec3& point) const {
    const Vec3 p = point / unit;
    return fmt::format("({:.6g}, {:.6g}, {:.6g}) {}", p.x(), p.y(), p.z(), word);
}

std::string MeshName::volume(double cubic_metres) const {
    return fmt::format("{:.9g} cubic {}", cubic_metres / std::pow(unit, 3), word);
}

Error MeshName::refused(const std::string& why, const std::string& remedy) const {
    return Error(asked_at, "file", "the mesh " + file + " " + why, remedy);
}

ClosedMesh closed(const Mesh& mesh, const MeshName& name, Diagnostics& diagnostics) {
    ClosedMesh out{merged(mesh), {}};
    const double rounding = rounding_of(out.mesh);
    Mended better = mended(out.mesh, rounding);
    if (open_edges(better.mesh).empty() && !better.mesh.faces.empty()) {
        if (better.largest > 0) {
            diagnostics.warning(
                name.asked_at, "file",
                fmt::format("the mesh {} has corners up to {:.2g} {} apart that are merged",
                            name.file, better.largest / name.unit, name.word),
                "Merge these corners in a mesh editor to avoid this warning.");
        }
        out.mesh = std::move(better.mesh);
    } else if (!open_edges(out.mesh).empty()) {
        throw not_closed(out.mesh, better.mesh, rounding, name);
    }
    if (out.mesh.faces.empty())
        throw name.refused("encloses no volume", "Give it some thickness, or leave out 'concave'.");
    out.shells = separate(out.mesh);
    if (const size_t turned = Nesting(out).sort_out(); turned > 0) {
        diagnostics.warning(
            name.asked_at, "file",
            fmt::format("of the mesh {}, {} of {} shells face inward and are not cavities; "
                        "they are turned around",
                        name.file, turned, out.shells.size()),
            "Orient the faces of its parts alike in a mesh editor.");
    }
    return out;
}

}  // namespace dihaptic::scene
