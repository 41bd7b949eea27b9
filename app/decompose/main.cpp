// dihaptic-decompose < MESH.off > PIECES: cuts a closed mesh into convex pieces, exactly (CGAL's
// Nef polyhedra; Chazelle 1984). For each piece it writes a line "piece COUNT" and then COUNT
// vertices, one per line. The program dihaptic calls it, under limits, and keeps the result; there
// is no need to call it by hand.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/IO/Polyhedron_iostream.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/convex_decomposition_3.h>

#include <exception>
#include <iostream>
#include <new>

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Polyhedron = CGAL::Polyhedron_3<Kernel>;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;

void decompose(std::istream& in, std::ostream& out) {
    Polyhedron surface;
    in >> surface;
    if (!in || !surface.is_closed()) throw std::runtime_error("the mesh is not a closed surface");
    Nef solid(surface);
    CGAL::convex_decomposition_3(solid);

    out.precision(17);
    // the first volume is the outside
    for (auto volume = ++solid.volumes_begin(); volume != solid.volumes_end(); ++volume) {
        if (!volume->mark()) continue;
        Polyhedron piece;
        solid.convert_inner_shell_to_polyhedron(volume->shells_begin(), piece);
        out << "piece " << piece.size_of_vertices() << "\n";
        for (auto v = piece.vertices_begin(); v != piece.vertices_end(); ++v) {
            const auto& p = v->point();
            out << CGAL::to_double(p.x()) << " " << CGAL::to_double(p.y()) << " "
                << CGAL::to_double(p.z()) << "\n";
        }
    }
    out.flush();
    if (!out) throw std::runtime_error("the pieces cannot be written");
}

}  // namespace

int main() {
    try {
        // CGAL prints nothing: the calling program reports the failure
        CGAL::set_error_handler([](const char*, const char*, const char*, int, const char*) {});
        decompose(std::cin, std::cout);
    } catch (const std::bad_alloc&) {
        return 3;
    } catch (const std::exception&) {
        return 1;
    }
    return 0;
}
