#include "scene/mend.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

namespace dihaptic::scene {
namespace {

/// Returns the mesh with each vertex i replaced with vertex `into[i]`.
Mesh joined(const Mesh& mesh, const std::vector<int>& into) {
    Mesh out;
    std::vector<int> index(mesh.vertices.size(), -1);
    const auto number = [&](int corner) {
        const auto kept = static_cast<size_t>(into[static_cast<size_t>(corner)]);
        if (index[kept] < 0) {
            index[kept] = static_cast<int>(out.vertices.size());
            out.vertices.push_back(mesh.vertices[kept]);
        }
        return index[kept];
    };
    // numbers the vertices first, so that they keep their order
    for (int i = 0; i < static_cast<int>(mesh.vertices.size()); ++i) number(i);
    for (const std::vector<int>& f : mesh.faces) {
        const std::array<int, 3> t{number(f[0]), number(f[1]), number(f[2])};
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) out.faces.push_back({t[0], t[1], t[2]});
    }
    return out;
}

/// Removes pairs of faces that have the same corners and opposite orientations.
void drop_back_to_back(Mesh& mesh) {
    const auto turned = [](std::vector<int> f) {
        std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
        return f;
    };
    std::map<std::vector<int>, std::vector<size_t>> there;
    std::set<size_t> dropped;
    for (size_t i = 0; i < mesh.faces.size(); ++i) {
        const std::vector<int> face = turned(mesh.faces[i]);
        const auto back = there.find({face[0], face[2], face[1]});
        if (back == there.end() || back->second.empty()) {
            there[face].push_back(i);
            continue;
        }
        dropped.insert({i, back->second.back()});
        back->second.pop_back();
    }
    if (dropped.empty()) return;
    size_t at = 0;
    std::erase_if(mesh.faces, [&](const std::vector<int>&) { return dropped.contains(at++); });
}

/// Finds, for a vertex, the first known vertex within a given distance.
class Neighbours {
  public:
    explicit Neighbours(double distance) : distance_(distance) {}
    std::optional<int> find(const Mesh& mesh, const Vec3& p) const {
        for (int i = 0; i < 27; ++i) {
            const auto found = cells_.find(cell(p, {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}));
            if (found == cells_.end()) continue;
            for (const int other : found->second) {
                if ((corner(mesh, other) - p).norm() <= distance_) return other;
            }
        }
        return std::nullopt;
    }
    void add(const Vec3& p, int i) { cells_[cell(p, {0, 0, 0})].push_back(i); }

  private:
    using Cell = std::array<int64_t, 3>;
    Cell cell(const Vec3& p, const std::array<int, 3>& offset) const {
        Cell out{};
        for (size_t i = 0; i < 3; ++i)
            out[i] = std::llround(p[static_cast<int>(i)] / distance_) + offset[i];
        return out;
    }
    const double distance_;
    std::map<Cell, std::vector<int>> cells_;
};

Mended welded(const Mesh& mesh, double rounding) {
    Mended out;
    Neighbours known(rounding);
    std::vector<int> into;
    for (const Vec3& v : mesh.vertices) {
        const int self = static_cast<int>(into.size());
        const int other = known.find(mesh, v).value_or(self);
        if (other == self) known.add(v, self);
        out.largest = std::max(out.largest, (corner(mesh, other) - v).norm());
        into.push_back(other);
    }
    out.mesh = joined(mesh, into);
    return out;
}

double height(const Mesh& mesh, const std::vector<int>& f) {
    const Vec3 a = corner(mesh, f[1]) - corner(mesh, f[0]);
    const Vec3 b = corner(mesh, f[2]) - corner(mesh, f[0]);
    return a.cross(b).norm() / std::max({a.norm(), b.norm(), (b - a).norm()});
}

/// The corners that lie on an edge, between its ends, ordered from its first end to its second.
std::vector<int> corners_on(const Mesh& mesh, const Edge& edge, const std::set<int>& corners,
                            double rounding) {
    const Vec3& a = corner(mesh, edge.first);
    const Vec3 along = corner(mesh, edge.second) - a;
    std::vector<std::pair<double, int>> out;
    for (const int i : corners) {
        if (i == edge.first || i == edge.second) continue;
        const double share = (corner(mesh, i) - a).dot(along) / along.squaredNorm();
        if (share > 0 && share < 1 && (a + share * along - corner(mesh, i)).norm() <= rounding)
            out.emplace_back(share, i);
    }
    std::sort(out.begin(), out.end());
    std::vector<int> sorted;
    for (const auto& [share, i] : out) sorted.push_back(i);
    return sorted;
}

/// Splits each face that has a corner of another face on one of its edges. Returns false if there
/// is no such face.
bool split(Mesh& mesh, double rounding) {
    const std::map<Edge, int> open = open_edges(mesh);
    std::set<int> corners;
    for (const auto& [edge, count] : open) corners.insert({edge.first, edge.second});
    std::vector<std::vector<int>> faces;
    for (const std::vector<int>& f : mesh.faces) {
        std::vector<int> on;
        size_t i = 0;
        for (; i < 3 && on.empty(); ++i) {
            const Edge edge{f[i], f[(i + 1) % 3]};
            const auto found = open.find(edge);
            if (found != open.end() && found->second > 0)
                on = corners_on(mesh, edge, corners, rounding);
        }
        if (on.empty()) {
            faces.push_back(f);
            continue;
        }
        const int opposite = f[(i + 1) % 3];
        on.insert(on.begin(), f[i - 1]);
        on.push_back(f[i % 3]);
        for (size_t k = 0; k + 1 < on.size(); ++k) faces.push_back({on[k], on[k + 1], opposite});
    }
    const bool any = faces.size() > mesh.faces.size();
    mesh.faces = std::move(faces);
    return any;
}

}  // namespace

std::map<Edge, int> open_edges(const Mesh& mesh) {
    std::map<Edge, int> out;
    for (const std::vector<int>& f : mesh.faces) {
        for (size_t i = 0; i < 3; ++i) {
            ++out[{f[i], f[(i + 1) % 3]}];
            --out[{f[(i + 1) % 3], f[i]}];
        }
    }
    std::erase_if(out, [](const auto& edge) { return edge.second <= 0; });
    return out;
}

double rounding_of(const Mesh& mesh) {
    if (mesh.vertices.empty()) return 0;
    Vec3 low = mesh.vertices.front();
    Vec3 high = low;
    double furthest = 0;
    for (const Vec3& v : mesh.vertices) {
        low = low.cwiseMin(v);
        high = high.cwiseMax(v);
        furthest = std::max(furthest, v.cwiseAbs().maxCoeff());
    }
    constexpr double kStep = std::numeric_limits<float>::epsilon();
    return std::max(1e-6 * (high - low).norm(), 8 * kStep * furthest);
}

Mesh merged(const Mesh& mesh) {
    std::map<std::array<double, 3>, int> known;
    std::vector<int> into;
    for (const Vec3& v : mesh.vertices)
        into.push_back(
            known.try_emplace({v.x(), v.y(), v.z()}, static_cast<int>(into.size())).first->second);
    Mesh out = joined(mesh, into);
    drop_back_to_back(out);
    return out;
}

Mended mended(const Mesh& mesh, double rounding) {
    Mended out = welded(mesh, rounding);
    std::erase_if(out.mesh.faces,
                  [&](const std::vector<int>& f) { return height(out.mesh, f) <= rounding; });
    drop_back_to_back(out.mesh);
    // in each round, one edge of each face is divided at all the corners on it
    constexpr int kRounds = 100;
    for (int i = 0; i < kRounds && split(out.mesh, rounding); ++i) drop_back_to_back(out.mesh);
    return out;
}

}  // namespace dihaptic::scene
