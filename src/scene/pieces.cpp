#include "scene/pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>

#include "base/companion.h"
#include "base/number.h"
#include "base/regular_file.h"
#include "base/text_file.h"
#include "base/user_folder.h"
#include "scene/closed.h"

namespace dihaptic::scene {
namespace {

/// The first line of files of the first version, in which the pieces may not fill the mesh.
constexpr const char* kUnchecked = "dihaptic pieces 1\n";
constexpr const char* kFirstLine = "dihaptic pieces 2\n";
constexpr const char* kDecomposer = "dihaptic-decompose";
constexpr int64_t kMostPieces = 1'000'000'000;  // bytes
/// Meshes with thousands of dents take minutes to cut, but the user can cancel the cut.
constexpr CompanionLimits kLimits{
    .processor_time = 3600, .time = 2 * 3600, .memory = 16'000'000'000, .output = kMostPieces};

/// FNV-1a hash.
class Fingerprint {
  public:
    void add(const void* data, size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3U;
    }
    uint64_t value() const { return value_; }

  private:
    uint64_t value_ = 0xcbf29ce484222325U;
};

uint64_t fingerprint(const Mesh& mesh) {
    Fingerprint out;
    for (const Vec3& v : mesh.vertices) out.add(v.data(), sizeof(double) * 3);
    for (const std::vector<int>& face : mesh.faces) out.add(face.data(), sizeof(int) * face.size());
    return out.value();
}

uint64_t fingerprint(const std::string& text) {
    Fingerprint out;
    out.add(text.data(), text.size());
    return out.value();
}

/// Writes the vertices of each piece in the format of dihaptic-decompose: "piece <count>", then one
/// vertex per line.
std::string text_of(const std::vector<Hull>& hulls) {
    std::string out;
    for (const Hull& hull : hulls) {
        out += fmt::format("piece {}\n", hull.vertices.size());
        for (const Vec3& v : hull.vertices) out += fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
    }
    return out;
}

/// What was read from "piece <count>" lines and the vertices after them.
struct Parsed {
    std::vector<Hull> hulls;
    std::optional<Vec3> lost;  ///< a corner that is in no hull, preferably one of a thin piece
};

std::optional<Vec3> lost_of(const std::vector<Vec3>& points, const Hull& hull) {
    for (const Vec3& p : points) {
        if (std::find(hull.vertices.begin(), hull.vertices.end(), p) == hull.vertices.end())
            return p;
    }
    return std::nullopt;
}

bool read(std::istream& in, double& value) {
    std::string word;
    in >> word;
    const auto number = finite_number(word);
    if (number) value = *number;
    return number.has_value();
}

std::optional<Parsed> parse(const std::string& text) {
    Parsed out;
    std::istringstream in(text);
    std::string word;
    size_t count = 0;
    while (in >> word) {
        if (word != "piece" || !(in >> count) || count > text.size()) return std::nullopt;
        std::vector<Vec3> points(count);
        for (Vec3& p : points) {
            for (double& along : p) {
                if (!read(in, along)) return std::nullopt;
            }
        }
        // sorted, so that pieces read from a file are bitwise equal to newly cut ones
        std::sort(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) {
            return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
        });
        Hull hull = convex_hull(points);
        // slivers that are flattened by rounding have hardly any volume, and cannot be touched
        // without their neighbours
        const std::optional<Vec3> lost = lost_of(points, hull);
        if (lost && (hull.faces.empty() || !out.lost)) out.lost = lost;
        if (!hull.faces.empty()) out.hulls.push_back(std::move(hull));
    }
    if (out.hulls.empty()) return std::nullopt;
    return out;
}

/// Reads the pieces of a mesh from a file; nullopt if the file does not contain them. `volume` is
/// the volume of the mesh, which pieces written by the first version must match.
std::optional<Pieces> read_pieces(const std::string& file, uint64_t mesh, double volume) {
    if (!is_there(file)) return std::nullopt;
    const std::string text = [&]() -> std::string {
        try {
            return read_bytes(file, kMostPieces);
        } catch (const Error&) {
            return "";  // the mesh is then cut again
        }
    }();
    const bool is_checked = text.starts_with(kFirstLine);
    const std::string head =
        fmt::format("{}mesh {:016x}\n", is_checked ? kFirstLine : kUnchecked, mesh);
    const size_t end = text.rfind("end ");
    if (!text.starts_with(head) || end == std::string::npos) return std::nullopt;
    const std::string body = text.substr(0, end);
    if (text.substr(end) != fmt::format("end {:016x}\n", fingerprint(body))) return std::nullopt;
    std::optional<Parsed> parsed = parse(body.substr(head.size()));
    if (!parsed) return std::nullopt;
    Pieces out{std::move(parsed->hulls), mesh};
    if (!is_checked && !is_same_size(integrate(out).volume, volume)) return std::nullopt;
    return out;
}

/// Writes the input for dihaptic-decompose (app/decompose/main.cpp).
std::string text_of(const ClosedMesh& solid) {
    std::string out;
    const auto add = [&](const Shell& shell, const char* kind, bool is_cavity) {
        std::map<int, size_t> number;
        std::string vertices;
        std::string faces;
        for (const size_t i : shell.faces) {
            std::array<size_t, 3> f{};
            for (size_t k = 0; k < 3; ++k) {
                const int at = solid.mesh.faces[i][k];
                const auto [known, is_new] = number.try_emplace(at, number.size());
                f[k] = known->second;
                const Vec3& v = solid.mesh.vertices[static_cast<size_t>(at)];
                if (is_new) vertices += fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
            }
            if (is_cavity) std::swap(f[1], f[2]);
            faces += fmt::format("{} {} {}\n", f[0], f[1], f[2]);
        }
        out +=
            fmt::format("{} {} {}\n{}{}", kind, number.size(), shell.faces.size(), vertices, faces);
    };
    for (size_t i = 0; i < solid.shells.size(); ++i) {
        if (solid.shells[i].within >= 0) continue;
        add(solid.shells[i], "solid", false);
        for (const Shell& cavity : solid.shells) {
            if (cavity.within == static_cast<int>(i)) add(cavity, "cavity", true);
        }
    }
    return out;
}

/// The output of dihaptic-decompose.
struct Cut {
    std::vector<Hull> hulls;       ///< empty if the solid cannot be cut
    double volume = 0;             ///< volume of the solid [m^3]
    double inverted = 0;           ///< volume enclosed by shells that face the wrong way [m^3]
    std::optional<Vec3> crossing;  ///< where a shell crosses or touches itself
    std::optional<Vec3> lost;      ///< see Parsed
};

Cut cut_of(const std::string& text) {
    Cut out;
    std::istringstream in(text);
    std::string word;
    for (std::streampos at = in.tellg(); in >> word; at = in.tellg()) {
        double shells = 0;
        Vec3 p = Vec3::Zero();
        if (word == "crossing") {
            if (read(in, p.x()) && read(in, p.y()) && read(in, p.z())) out.crossing = p;
        } else if (word == "inverted") {
            in >> out.inverted;
        } else if (word == "volume") {
            if (!read(in, out.volume) || !read(in, shells)) break;
        } else {
            if (const std::optional<Parsed> first = parse(text.substr(at))) {
                // rounds the pieces to the form that they will have when read from a file
                if (std::optional<Parsed> again = parse(text_of(first->hulls)))
                    out.hulls = std::move(again->hulls);
                out.lost = first->lost;
            }
            break;
        }
    }
    return out;
}

/// Whether the pieces extend as far as the mesh along each axis.
bool reach(const std::vector<Hull>& hulls, const Mesh& mesh) {
    const auto grow = [](Eigen::AlignedBox3d& box, const std::vector<Vec3>& points) {
        for (const Vec3& p : points) box.extend(p);
    };
    Eigen::AlignedBox3d pieces;
    Eigen::AlignedBox3d whole;
    for (const Hull& hull : hulls) grow(pieces, hull.vertices);
    for (const std::vector<int>& f : mesh.faces) {
        for (const int i : f) whole.extend(mesh.vertices[static_cast<size_t>(i)]);
    }
    const double most = kSameSize * whole.diagonal().norm();
    return (pieces.min() - whole.min()).norm() <= most &&
           (pieces.max() - whole.max()).norm() <= most;
}

/// Runs dihaptic-decompose with one of its methods and returns the result.
Cut cut_by(const std::string& way, const ClosedMesh& solid, const MeshName& name,
           const std::stop_token& stop) {
    const CompanionTask task{
        kDecomposer,
        {way},
        kLimits,
        "cutting " + name.file + " into convex pieces",
        "Repair faces that intersect, or give it fewer, in a mesh editor, or leave out 'concave'.",
        name.asked_at,
        "concave",
        stop};
    const std::optional<std::string> text = run_companion(task, text_of(solid));
    return text ? cut_of(*text) : Cut{};
}

/// The reason why a mesh is refused, and the remedy; both are empty if the mesh is accepted.
struct Fault {
    std::string why;
    std::string remedy =
        "Repair the faces there in a mesh editor, or unite its parts there, or "
        "leave out 'concave'.";
};

Fault fault_of(const Cut& cut, const ClosedMesh& solid, const MeshName& name) {
    if (cut.inverted > kSameSize * cut.volume)
        return {fmt::format("encloses {} the wrong way round, besides {} of solid",
                            name.volume(cut.inverted), name.volume(cut.volume))};
    if (cut.hulls.empty()) return {"cannot be cut into convex pieces"};
    const double filled = integrate(Pieces{cut.hulls}).volume;
    const std::string both = fmt::format("has {}, but its convex pieces have {}",
                                         name.volume(cut.volume), name.volume(filled));
    const bool is_filled = is_same_size(filled, cut.volume);
    if (!is_filled)
        return {fmt::format("{}: faces that should be flat are bent by rounding{}, and parts "
                            "too thin to be felt are lost",
                            both, cut.lost ? ", near " + name.place(*cut.lost) : ""),
                "Export it with more digits, or leave out 'concave'."};
    if (!reach(cut.hulls, solid.mesh)) return {"extends further than its convex pieces"};
    return {""};
}

std::vector<Hull> decompose(const ClosedMesh& solid, const MeshName& name,
                            const std::stop_token& stop) {
    std::optional<Vec3> crossing;
    Fault fault;
    for (const std::string way : {"shells", "winding"}) {
        Cut cut;
        try {
            cut = cut_by(way, solid, name, stop);
        } catch (const Error&) {
            // the library crashes on some solids, which the other method may be able to cut
            if (stop.stop_requested() || way == "winding") throw;
            continue;
        }
        fault = fault_of(cut, solid, name);
        if (fault.why.empty()) return std::move(cut.hulls);
        if (cut.crossing) crossing = cut.crossing;
    }
    const std::string near =
        crossing ? "; its faces cross or touch each other near " + name.place(*crossing) : "";
    throw name.refused(fault.why + near, fault.remedy);
}

}  // namespace

std::string pieces_file(const std::string& mesh_file) {
    return mesh_file + ".pieces";
}

void write_pieces(const Pieces& pieces, const std::string& file) {
    const std::string body =
        fmt::format("{}mesh {:016x}\n", kFirstLine, pieces.mesh) + text_of(pieces.hulls);
    write_file(body + fmt::format("end {:016x}\n", fingerprint(body)), file);
}

namespace {

/// Path of the file that stores the pieces of a mesh. The file is in the user's own cache, because
/// the mesh's folder may belong to somebody else. "" if the user has no home directory.
std::string kept_file(uint64_t print) {
    const std::string cache = user_cache();
    return cache.empty() ? "" : fmt::format("{}/dihaptic/pieces/{:016x}.pieces", cache, print);
}

void keep(const Pieces& pieces, const std::string& file) {
    if (file.empty()) throw Error("you have no home folder", "Set HOME.");
    std::error_code failed;
    std::filesystem::create_directories(std::filesystem::path(file).parent_path(), failed);
    write_pieces(pieces, file);
}

}  // namespace

namespace {

/// Warns about overlapping shells: their union determines both the contact surface and the mass.
void check_overlap(const ClosedMesh& solid, const Pieces& pieces, const MeshName& name,
                   Diagnostics& diagnostics) {
    const double shells = integrate(solid.mesh.vertices, solid.mesh.faces).volume;
    const double united = integrate(pieces).volume;
    if (is_same_size(shells, united)) return;
    diagnostics.warning(
        name.asked_at, "file",
        fmt::format("the mesh {} has overlapping parts: they add up to {}, but their union, "
                    "which is felt and weighed, has {}",
                    name.file, name.volume(shells), name.volume(united)),
        "Unite its parts in a mesh editor, and turn the faces of cavities inward.");
}

}  // namespace

VolumeIntegrals integrate(const Pieces& pieces) {
    VolumeIntegrals out;
    std::vector<VolumeIntegrals> parts;
    Vec3 first = Vec3::Zero();
    for (const Hull& hull : pieces.hulls) {
        parts.push_back(integrate(hull.vertices, hull.faces));
        out.volume += parts.back().volume;
        first += parts.back().volume * parts.back().centre;
    }
    if (out.volume <= 0) return out;
    out.centre = first / out.volume;
    for (const VolumeIntegrals& part : parts) {
        const Vec3 r = part.centre - out.centre;
        out.inertia +=
            part.inertia + part.volume * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
    }
    return out;
}

Pieces convex_pieces(const ClosedMesh& solid, const MeshName& name, Diagnostics& diagnostics,
                     const std::stop_token& stop) {
    const uint64_t print = fingerprint(solid.mesh);
    const std::string kept = kept_file(print);
    const double volume = integrate(solid.mesh.vertices, solid.mesh.faces).volume;
    for (const std::string& there : {pieces_file(name.file), kept}) {
        std::optional<Pieces> pieces = read_pieces(there, print, volume);
        if (!pieces || !reach(pieces->hulls, solid.mesh)) continue;
        check_overlap(solid, *pieces, name, diagnostics);
        return *std::move(pieces);
    }
    Pieces pieces{decompose(solid, name, stop), print};
    check_overlap(solid, pieces, name, diagnostics);
    try {
        keep(pieces, kept);
    } catch (const Error& e) {
        diagnostics.warning(name.asked_at, "file",
                            fmt::format("the convex pieces of {} cannot be kept: {} {}", name.file,
                                        kept, e.problems().front().what),
                            "They are cut again in each run until that folder can be written to.");
    }
    return pieces;
}

}  // namespace dihaptic::scene
