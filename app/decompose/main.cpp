// dihaptic-decompose shells|winding < SHELLS > PIECES: cuts a solid into convex pieces, exactly
// (with CGAL's Nef polyhedra; Chazelle 1984). It reads shells: for each, a line with "solid" or
// "cavity" and the numbers of vertices and triangles, followed by the vertices and the triangles,
// one per line. All shells, including cavities, must be closed and face outward; a cavity is cut
// out of the solid that precedes it. The program dihaptic calls this program, with resource limits,
// and stores the result; there is no need to call it by hand.
//
// "shells" makes a solid from each shell and unites the solids. "winding" takes longer, and only
// assumes that all shells together form a closed surface (arrangement.h).
//
// The output consists of "crossing X Y Z", a point where a shell crosses or touches itself, if
// there is one; "inverted VOLUME", the volume that a shell encloses with the wrong orientation;
// "volume SOLID SHELLS", the volume of the solid, in which overlapping shells count once, and the
// sum of the volumes of the shells; and, for each piece, a line "piece COUNT" followed by COUNT
// vertices, one per line.
#include "arrangement.h"
#include "solids.h"
// after the Nef polyhedra (solids.h), without which these headers do not compile
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polyhedron_incremental_builder_3.h>
#include <CGAL/convex_decomposition_3.h>

#include <cmath>
#include <exception>
#include <iostream>
#include <new>
#include <optional>
#include <sstream>

namespace {

using namespace dihaptic::decompose;

/// Relative difference up to which two volumes are considered equal.
constexpr double kSame = 1e-9;

struct Shell {
    bool is_cavity = false;
    std::vector<Point> points;
    std::vector<std::array<size_t, 3>> faces;

    Triangle triangle(const std::array<size_t, 3>& f) const {
        return {points[f[0]], points[f[1]], points[f[2]]};
    }
};

std::vector<Shell> read(std::istream& in) {
    std::vector<Shell> out;
    size_t vertices = 0;
    size_t faces = 0;
    for (std::string kind; in >> kind >> vertices >> faces;) {
        Shell shell{kind == "cavity", {}, {}};
        double x = 0;
        double y = 0;
        double z = 0;
        while (shell.points.size() < vertices && in >> x >> y >> z)
            shell.points.emplace_back(x, y, z);
        size_t a = 0;
        size_t b = 0;
        size_t c = 0;
        while (shell.faces.size() < faces && in >> a >> b >> c) {
            if (std::max({a, b, c}) >= vertices) throw std::runtime_error("no such vertex");
            shell.faces.push_back({a, b, c});
        }
        out.push_back(std::move(shell));
    }
    if (out.empty() || out.front().is_cavity) throw std::runtime_error("there is no solid");
    return out;
}

double enclosed(const Shell& shell) {
    Number sum = 0;
    for (const auto& f : shell.faces) {
        const Triangle t = shell.triangle(f);
        sum += six_volumes({t[0], t[1], t[2]});
    }
    return CGAL::to_double(sum) / 6;
}

/// Builds a polyhedron from a shell.
class Build : public CGAL::Modifier_base<Polyhedron::HalfedgeDS> {
  public:
    explicit Build(const Shell& shell) : shell_(shell) {}
    void operator()(Polyhedron::HalfedgeDS& target) override {
        CGAL::Polyhedron_incremental_builder_3<Polyhedron::HalfedgeDS> builder(target);
        builder.begin_surface(shell_.points.size(), shell_.faces.size());
        for (const Point& p : shell_.points) builder.add_vertex(p);
        for (const auto& f : shell_.faces) {
            if (!builder.test_facet(f.begin(), f.end())) throw std::runtime_error("not a surface");
            builder.add_facet(f.begin(), f.end());
        }
        builder.end_surface();
    }

  private:
    const Shell& shell_;
};

/// The solid enclosed by a shell. Throws an error that gives a point where the shell crosses or
/// touches itself.
Nef inside(const Shell& shell) {
    Polyhedron surface;
    Build build(shell);
    surface.delegate(build);
    if (!surface.is_closed()) throw std::runtime_error("not closed");
    using Face = Polyhedron::Facet_handle;
    std::vector<std::pair<Face, Face>> crossings;
    CGAL::Polygon_mesh_processing::self_intersections(surface, std::back_inserter(crossings));
    if (!crossings.empty()) {
        const auto corner = crossings.front().first->halfedge();
        const Point p = CGAL::centroid(corner->vertex()->point(), corner->next()->vertex()->point(),
                                       corner->next()->next()->vertex()->point());
        std::cout << "crossing " << CGAL::to_double(p.x()) << " " << CGAL::to_double(p.y()) << " "
                  << CGAL::to_double(p.z()) << "\n";
        throw std::runtime_error("crosses itself");
    }
    Nef solid(surface);
    const double wanted = enclosed(shell);
    if (std::abs(volume_of(solid) - wanted) > kSame * wanted)
        throw std::runtime_error("not filled");
    return solid;
}

/// The union of all solids, each without its cavities.
Nef by_shells(const std::vector<Shell>& shells) {
    Nef all;
    Nef one;
    for (size_t i = 0; i < shells.size(); ++i) {
        const Nef next = inside(shells[i]);
        one = shells[i].is_cavity ? one - next : next;
        const bool is_last = i + 1 == shells.size() || !shells[i + 1].is_cavity;
        if (is_last) all = i == 0 || all.is_empty() ? one : all + one;
    }
    return shells.size() == 1 ? all : all.regularization();
}

Nef by_winding(const std::vector<Shell>& shells) {
    std::vector<Triangle> triangles;
    for (const Shell& shell : shells) {
        for (const auto& f : shell.faces) {
            Triangle t = shell.triangle(f);
            if (shell.is_cavity) std::swap(t[1], t[2]);
            if (normal_of(t) != CGAL::NULL_VECTOR) triangles.push_back(t);
        }
    }
    Wound all = wound(triangles);
    if (all.inverted > 0) std::cout << "inverted " << all.inverted << "\n";
    return all.solid;
}

/// Writes the convex pieces of a solid. Throws when the pieces do not fill the solid.
void cut(Nef solid, std::ostream& out) {
    const double whole = volume_of(solid);
    CGAL::convex_decomposition_3(solid);
    if (!(whole > 0) || std::abs(volume_of(solid) - whole) > kSame * whole)
        throw std::runtime_error("the pieces do not fill the solid");
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
}

void decompose(const std::string& way, const std::vector<Shell>& shells) {
    std::cout.precision(17);
    const Nef solid = way == "winding" ? by_winding(shells) : by_shells(shells);
    double sum = 0;
    for (const Shell& shell : shells) sum += shell.is_cavity ? -enclosed(shell) : enclosed(shell);
    std::ostringstream pieces;
    pieces.precision(17);
    cut(solid, pieces);
    std::cout << "volume " << volume_of(solid) << " " << sum << "\n" << pieces.str();
}

}  // namespace

int main(int count, char** arguments) {
    try {
        // CGAL must print nothing, because the calling program reports the failure
        CGAL::set_error_handler([](const char*, const char*, const char*, int, const char*) {});
        decompose(count > 1 ? arguments[1] : "shells", read(std::cin));
    } catch (const std::bad_alloc&) {
        return 3;
    } catch (const std::exception&) {
        // the output contains the point but no pieces
    }
    std::cout.flush();
    return std::cout ? 0 : 1;
}
