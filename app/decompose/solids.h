// Solids enclosed by the triangles of a mesh, as exact Nef polyhedra of CGAL.
#pragma once

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polyhedron_3.h>

#include <array>
#include <cmath>
#include <vector>

namespace dihaptic::decompose {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;
using Polyhedron = CGAL::Polyhedron_3<Kernel>;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;

using Triangle = std::array<Point, 3>;

inline Vector normal_of(const Triangle& t) {
    return CGAL::cross_product(t[1] - t[0], t[2] - t[0]);
}

/// The corners along one edge cycle of a halffacet.
template <class Circulator>
std::vector<Point> corners(Circulator edge) {
    std::vector<Point> out;
    const Circulator first = edge;
    do out.push_back(edge->source()->center_vertex()->point());
    while (++edge != first);
    return out;
}

/// Six times the volume between the origin and a cycle of a planar facet. The values for the cycles
/// of a facet with holes add up.
inline Number six_volumes(const std::vector<Point>& cycle) {
    Vector area = CGAL::NULL_VECTOR;  // twice
    const Vector start = cycle[0] - CGAL::ORIGIN;
    for (size_t i = 1; i + 1 < cycle.size(); ++i)
        area = area + CGAL::cross_product(cycle[i] - cycle[0], cycle[i + 1] - cycle[0]);
    return start * area;
}

/// The volume of the selected cells, e.g. of all marked cells.
template <class Circulator, class Structure, class Counts>
double volume_of(Structure& cells, const Counts& counts) {
    Number sum = 0;
    for (auto f = cells.halffacets_begin(); f != cells.halffacets_end(); ++f) {
        if (!counts(f->incident_volume())) continue;
        for (auto cycle = f->facet_cycles_begin(); cycle != f->facet_cycles_end(); ++cycle) {
            if (cycle.is_shalfedge()) sum += six_volumes(corners(Circulator(cycle)));
        }
    }
    return std::abs(CGAL::to_double(sum)) / 6;
}

inline double volume_of(const Nef& nef) {
    return volume_of<Nef::SHalfedge_around_facet_const_circulator>(
        nef, [](const auto& cell) { return cell->mark(); });
}

}  // namespace dihaptic::decompose
