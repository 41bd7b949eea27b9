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

namespace dihaptic::scene {
namespace {

constexpr const char* kFirstLine = "dihaptic pieces 1";
constexpr const char* kDecomposer = "dihaptic-decompose";
constexpr int64_t kMostPieces = 1'000'000'000;  // bytes
/// Meshes with thousands of dents take minutes to cut; the user can cancel.
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

/// The vertices of each piece, as dihaptic-decompose writes them: "piece <count>", then one vertex
/// per line.
std::string text_of(const std::vector<Hull>& hulls) {
    std::string out;
    for (const Hull& hull : hulls) {
        out += fmt::format("piece {}\n", hull.vertices.size());
        for (const Vec3& v : hull.vertices) out += fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
    }
    return out;
}

std::optional<std::vector<Hull>> hulls_of(const std::string& text) {
    std::vector<Hull> hulls;
    std::istringstream in(text);
    std::string word;
    size_t count = 0;
    while (in >> word) {
        if (word != "piece" || !(in >> count) || count > text.size()) return std::nullopt;
        std::vector<Vec3> points(count);
        for (Vec3& p : points) {
            for (double& along : p) {
                in >> word;
                const auto number = finite_number(word);
                if (!in || !number) return std::nullopt;
                along = *number;
            }
        }
        // sorted, so that pieces read from a file equal the newly cut ones to the bit
        std::sort(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) {
            return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
        });
        Hull hull = convex_hull(points);
        // slivers that rounding has flattened hold no volume, and cannot be touched without their
        // neighbours
        if (!hull.faces.empty()) hulls.push_back(std::move(hull));
    }
    if (hulls.empty()) return std::nullopt;
    return hulls;
}

std::optional<Pieces> read_pieces(const std::string& file, uint64_t mesh) {
    if (!is_there(file)) return std::nullopt;
    const std::string text = [&]() -> std::string {
        try {
            return read_bytes(file, kMostPieces);
        } catch (const Error&) {
            return "";  // then the mesh is cut anew
        }
    }();
    const std::string head = fmt::format("{}\nmesh {:016x}\n", kFirstLine, mesh);
    const size_t end = text.rfind("end ");
    if (!text.starts_with(head) || end == std::string::npos) return std::nullopt;
    const std::string body = text.substr(0, end);
    if (text.substr(end) != fmt::format("end {:016x}\n", fingerprint(body))) return std::nullopt;
    std::optional<std::vector<Hull>> hulls = hulls_of(body.substr(head.size()));
    if (!hulls) return std::nullopt;
    return Pieces{*std::move(hulls), mesh};
}

std::string off_of(const Mesh& mesh) {
    std::string off = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.faces.size());
    for (const Vec3& v : mesh.vertices) off += fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
    for (const std::vector<int>& f : mesh.faces)
        off += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
    return off;
}

std::vector<Hull> decompose(const Mesh& mesh, const std::string& file, const Place& asked_at,
                            const std::stop_token& stop) {
    const CompanionTask task{
        kDecomposer,
        {},
        kLimits,
        "cutting " + file + " into convex pieces",
        "Repair faces that intersect, or give it fewer, in a mesh editor, or leave out concave.",
        asked_at,
        "concave",
        stop};
    const std::optional<std::string> text = run_companion(task, off_of(mesh));
    std::optional<std::vector<Hull>> hulls = text ? hulls_of(*text) : std::nullopt;
    if (hulls) hulls = hulls_of(text_of(*hulls));  // as they will be when read from the file
    if (!hulls) {
        throw Error(
            asked_at, "file", "the mesh " + file + " cannot be cut into convex pieces",
            "Look for faces that intersect or touch each other in a mesh editor, and repair them.");
    }
    return *std::move(hulls);
}

}  // namespace

Mesh closed(const Mesh& mesh, const std::string& file, const Place& asked_at) {
    Mesh out;
    std::map<std::array<double, 3>, int> known;
    std::vector<int> index;
    for (const Vec3& v : mesh.vertices) {
        const auto [at, is_new] =
            known.try_emplace({v.x(), v.y(), v.z()}, static_cast<int>(out.vertices.size()));
        if (is_new) out.vertices.push_back(v);
        index.push_back(at->second);
    }
    std::map<std::pair<int, int>, int> edges;  // each directed edge must be used exactly once
    for (const std::vector<int>& f : mesh.faces) {
        const std::array<int, 3> t{index[static_cast<size_t>(f[0])],
                                   index[static_cast<size_t>(f[1])],
                                   index[static_cast<size_t>(f[2])]};
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;  // a face without area
        out.faces.push_back({t[0], t[1], t[2]});
        for (size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    }
    size_t open = 0;
    for (const auto& [edge, count] : edges) {
        const auto back = edges.find({edge.second, edge.first});
        if (count != 1 || back == edges.end() || back->second != 1) ++open;
    }
    if (open > 0) {
        throw Error(
            asked_at, "file",
            fmt::format("the mesh {} is not closed: {} of its edges do not join two faces of "
                        "the same orientation",
                        file, open),
            "Close its holes and orient its faces alike in a mesh editor, or leave out concave.");
    }
    if (integrate(out.vertices, out.faces).volume < 0) {
        for (std::vector<int>& face : out.faces) std::swap(face[1], face[2]);
    }
    return out;
}

std::string pieces_file(const std::string& mesh_file) {
    return mesh_file + ".pieces";
}

void write_pieces(const Pieces& pieces, const std::string& file) {
    const std::string body =
        fmt::format("{}\nmesh {:016x}\n", kFirstLine, pieces.mesh) + text_of(pieces.hulls);
    write_file(body + fmt::format("end {:016x}\n", fingerprint(body)), file);
}

namespace {

/// Where the pieces of a mesh are kept: with the user, since the mesh's folder may be somebody
/// else's; "" if the user has no home.
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

Pieces convex_pieces(const Mesh& mesh, const std::string& file, const Place& asked_at,
                     Diagnostics& diagnostics, const std::stop_token& stop) {
    const uint64_t print = fingerprint(mesh);
    const std::string kept = kept_file(print);
    for (const std::string& there : {pieces_file(file), kept}) {
        if (std::optional<Pieces> pieces = read_pieces(there, print)) return *std::move(pieces);
    }
    Pieces pieces{decompose(mesh, file, asked_at, stop), print};
    try {
        keep(pieces, kept);
    } catch (const Error& e) {
        diagnostics.warning(asked_at, "file",
                            fmt::format("the convex pieces of {} cannot be kept: {} {}", file, kept,
                                        e.problems().front().what),
                            "They are cut anew in each run, unless that folder can be written to.");
    }
    return pieces;
}

}  // namespace dihaptic::scene
