// Computes the solid enclosed by a closed surface, even if its triangles cross each other, lie on
// one another, or meet without shared corners. The union of the triangles cuts space into cells,
// and a cell is solid if the surface winds around it at least once. The winding number of the outer
// cell is 0. Crossing a facet changes the winding number by the number of triangles at the facet
// that face one way minus the number that face the other way.
#pragma once

#include "solids.h"
// after the Nef polyhedra (solids.h), without which these headers do not compile
#include <CGAL/Nef_3/Mark_bounded_volumes.h>
#include <CGAL/Nef_nary_union_3.h>

#include <map>
#include <stdexcept>

namespace dihaptic::decompose {

/// A triangle, projected along the axis to which its plane is steepest.
struct Flat {
    int u;
    int v;
    explicit Flat(const Vector& normal) {
        int axis = 0;
        for (int i = 1; i < 3; ++i) {
            if (std::abs(CGAL::to_double(normal[i])) > std::abs(CGAL::to_double(normal[axis])))
                axis = i;
        }
        u = (axis + 1) % 3;
        v = (axis + 2) % 3;
    }
    CGAL::Sign turn(const Vector& a, const Vector& b) const {
        return CGAL::sign(a[u] * b[v] - a[v] * b[u]);
    }
};

/// Whether a triangle contains the point at an infinitesimal distance from p in the direction d,
/// which lies in the triangle's plane.
inline bool contains(const Triangle& t, const Point& p, const Vector& d) {
    const Flat flat(normal_of(t));
    std::array<CGAL::Sign, 3> side{};
    for (size_t i = 0; i < 3; ++i) {
        const Vector edge = t[(i + 1) % 3] - t[i];
        side[i] = flat.turn(edge, p - t[i]);
        if (side[i] == CGAL::ZERO) side[i] = flat.turn(edge, d);
        if (side[i] == CGAL::ZERO) throw std::runtime_error("the step runs along an edge");
    }
    return side[0] == side[1] && side[1] == side[2];
}

/// Marks the cells that are solid.
class MarkWound : public CGAL::Modifier_base<Nef::SNC_structure> {
  public:
    explicit MarkWound(const std::vector<Triangle>& triangles) : triangles_(triangles) {}

    void operator()(Nef::SNC_structure& snc) override {
        std::map<Volume, std::vector<std::pair<Volume, int>>> doors;
        for (auto f = snc.halffacets_begin(); f != snc.halffacets_end(); ++f)
            doors[f->twin()->incident_volume()].emplace_back(f->incident_volume(), jump(f));
        // the first volume is the outside
        std::map<Volume, int> winding{{snc.volumes_begin(), 0}};
        std::vector<Volume> open{snc.volumes_begin()};
        while (!open.empty()) {
            const Volume from = open.back();
            open.pop_back();
            for (const auto& [to, change] : doors[from]) {
                const auto [known, is_new] = winding.try_emplace(to, winding[from] + change);
                if (known->second != winding[from] + change)
                    throw std::runtime_error("the surface is not closed");
                if (is_new) open.push_back(to);
            }
        }
        for (const auto& [cell, number] : winding) mark(snc, cell, number > 0);
        inverted_ = volume_of<Snc::SHalfedge_around_facet_circulator>(
            snc, [&](const Volume& cell) { return winding[cell] < 0; });
    }
    /// The volume of the cells that the surface encloses with the wrong orientation.
    double inverted() const { return inverted_; }

  private:
    using Snc = Nef::SNC_structure;
    using Volume = Snc::Volume_handle;

    /// The difference between the winding number of the halffacet's volume, to which its normal
    /// points, and that of the volume behind it.
    int jump(Snc::Halffacet_handle f) const {
        const Snc::SHalfedge_handle edge(f->facet_cycles_begin());
        const std::vector<Point> cycle = corners(Snc::SHalfedge_around_facet_circulator(edge));
        const Vector normal = f->plane().orthogonal_vector();
        const Vector along = cycle[1] - cycle[0];
        // oblique, so that it does not meet the edge of any triangle
        const Vector inward = CGAL::cross_product(normal, along) /
                                  std::sqrt(CGAL::to_double(normal.squared_length())) +
                              Number(0.3719) * along;
        const Point middle = CGAL::midpoint(cycle[0], cycle[1]);
        int out = 0;
        for (const Triangle& t : triangles_) {
            const auto is_on = [&](const Point& p) { return f->plane().has_on(p); };
            if (!is_on(t[0]) || !is_on(t[1]) || !is_on(t[2]) || !contains(t, middle, inward))
                continue;
            out -= CGAL::sign(normal * normal_of(t));
        }
        return out;
    }
    static void mark(Snc& snc, Volume cell, bool is_solid) {
        cell->mark() = is_solid;
        CGAL::Volume_setter<Snc, bool> set(is_solid);
        Snc::SNC_decorator decorator(snc);
        for (auto shell = cell->shells_begin(); shell != cell->shells_end(); ++shell)
            decorator.visit_shell_objects(Snc::SFace_handle(shell), set);
    }

    const std::vector<Triangle>& triangles_;
    double inverted_ = 0;
};

struct Wound {
    Nef solid;
    double inverted = 0;  ///< volume that the surface encloses with the wrong orientation
};

/// The solid around which the triangles wind.
inline Wound wound(const std::vector<Triangle>& triangles) {
    CGAL::Nef_nary_union_3<Nef> sheets;
    for (const Triangle& t : triangles)
        sheets.add_polyhedron(Nef(t.begin(), t.end(), normal_of(t)));
    Wound out{sheets.get_union()};
    MarkWound marks(triangles);
    out.solid.delegate(marks);
    out.solid = out.solid.regularization();
    out.inverted = marks.inverted();
    return out;
}

}  // namespace dihaptic::decompose
