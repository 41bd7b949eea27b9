#include "scene/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>

#include "base/checksum.h"
#include "base/companion.h"
#include "base/regular_file.h"
#include "scene/materials.h"
#include "scene/mesh_text.h"

namespace dihaptic::scene {

namespace {

constexpr const char* kReader = "dihaptic-mesh";
constexpr const char* kRemedy = "Export it again as OBJ, STL or PLY, with its surface.";
constexpr int64_t kLargestFile = 400'000'000;  // size limit [bytes]: millions of triangles

/// The extension of the file's name in lower case, if such files can be read; otherwise "".
std::string format_of(const std::string& file) {
    std::string ending = std::filesystem::path(file).extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const char* known : {".obj", ".stl", ".ply", ".off"}) {
        if (ending == known) return ending.substr(1);
    }
    return "";
}

/// Describes what an OBJ file lacks for a solid, because the reader does not report it; "" if
/// nothing is missing, or if the file has another format.
std::string missing_in(const std::string& bytes, const std::string& format) {
    if (format != "obj") return "";
    std::istringstream in(bytes);
    size_t vertices = 0;
    size_t faces = 0;
    for (std::string line; std::getline(in, line);) {
        const std::string word = line.substr(0, line.find_first_of(" \t"));
        if (word == "v") ++vertices;
        if (word == "f") ++faces;
    }
    const auto counted = [&](size_t n, const char* one, const char* many) {
        return n == 0 ? fmt::format("no {}", many) : fmt::format("{} {}", n, n == 1 ? one : many);
    };
    if (vertices >= 4 && faces >= 4) return "";
    return fmt::format("has {} ('v') and {} ('f'), but a solid needs at least four of each",
                       counted(vertices, "vertex", "vertices"), counted(faces, "face", "faces"));
}

/// Time and memory limits for a file of `size` bytes. Intact files take at most a tenth of this
/// time and half of this memory: 0.04 s of computing time per MB, and 12 to 150 bytes of memory per
/// byte, the latter for small OBJ files with more faces than vertices. A file that takes more is
/// damaged.
CompanionLimits limits_for(uint64_t size) {
    CompanionLimits out;
    out.processor_time = static_cast<int>(2 + size / 2'000'000);
    out.time = 60 + 10 * out.processor_time;
    out.memory = std::min<uint64_t>(512'000'000 + 200 * size, 8'000'000'000);
    out.output = 1'000'000 + 20 * size;
    return out;
}

/// Reads the output of dihaptic-mesh, item by item.
class Reader {
  public:
    explicit Reader(const std::string& bytes) : bytes_(bytes) {}
    bool starts_with(std::string_view text) {
        if (!std::string_view(bytes_).starts_with(text)) return false;
        at_ = text.size();
        return true;
    }
    size_t left() const { return bytes_.size() - at_; }
    template <class Item>
    bool next(Item& out) {
        if (left() < sizeof(Item)) return false;
        std::memcpy(&out, bytes_.data() + at_, sizeof(Item));
        at_ += sizeof(Item);
        return true;
    }
    /// Reads text up to the next zero byte, or to the end.
    std::string word() {
        const size_t end = std::min(bytes_.find('\0', at_), bytes_.size());
        std::string out = bytes_.substr(at_, end - at_);
        at_ = std::min(end + 1, bytes_.size());
        return out;
    }

  private:
    const std::string& bytes_;
    size_t at_ = 0;
};

/// Consecutive vertices with the same material.
struct MeshPart {
    size_t vertices = 0;
    std::string material;
};

struct MeshParts {
    Mesh mesh;
    std::vector<MeshPart> parts;
};

/// Reads the colours and parts of a mesh, which are the last items in the output of dihaptic-mesh.
/// Returns false if the parts do not match the mesh.
bool read_colours(Reader& in, uint64_t count, MeshParts& out) {
    const size_t vertices = out.mesh.vertices.size();
    out.mesh.colours.reserve(vertices);
    for (int32_t c = -1; out.mesh.colours.size() < vertices && in.next(c);)
        out.mesh.colours.push_back(c);
    size_t left = vertices;
    for (uint64_t size = 0; out.parts.size() < count && in.next(size);) {
        if (size > left) return false;
        left -= size;
        out.parts.push_back({size, ""});
    }
    for (MeshPart& part : out.parts) part.material = in.word();
    return left == 0 && in.left() == 0;
}

/// Reads the mesh that dihaptic-mesh has written (app/mesh/main.cpp), whose coordinates are
/// relative to `from`; nullopt if the bytes do not form a mesh.
std::optional<MeshParts> mesh_of(const std::string& bytes, double unit,
                                 const std::array<double, 3>& from) {
    using Vertex = std::array<double, 3>;
    using Face = std::array<uint32_t, 3>;
    Reader in(bytes);
    std::array<uint64_t, 3> counts{};
    if (!in.starts_with("dihaptic mesh 2\n") || !in.next(counts)) return std::nullopt;
    const auto [vertices, faces, parts] = counts;
    constexpr uint64_t kMost = INT32_MAX;
    if (vertices > kMost || faces > kMost || parts > kMost ||
        in.left() < vertices * (sizeof(Vertex) + sizeof(int32_t)) + faces * sizeof(Face) +
                        parts * sizeof(uint64_t))
        return std::nullopt;
    MeshParts out;
    Mesh& mesh = out.mesh;
    mesh.vertices.reserve(vertices);
    mesh.faces.reserve(faces);
    for (Vertex v; mesh.vertices.size() < vertices && in.next(v);)
        mesh.vertices.push_back(unit * Vec3(from[0] + v[0], from[1] + v[1], from[2] + v[2]));
    for (Face f; mesh.faces.size() < faces && in.next(f);) {
        for (const uint32_t index : f) {
            if (index >= vertices) return std::nullopt;
        }
        mesh.faces.emplace_back(f.begin(), f.end());
    }
    if (!read_colours(in, parts, out)) return std::nullopt;
    return out;
}

/// Gives each vertex without a colour the colour of its material. If no vertex has a colour after
/// that, the mesh has no colours.
void add_materials(MeshParts& read) {
    Mesh& mesh = read.mesh;
    const Materials read_ones =
        mesh.materials.empty() ? Materials{} : read_materials(mesh.materials);
    const auto& materials = read_ones.colours;
    mesh.materials_checksum = read_ones.checksum;
    auto vertex = mesh.colours.begin();
    for (const MeshPart& part : read.parts) {
        const auto material = materials.find(part.material);
        const auto end = vertex + static_cast<std::ptrdiff_t>(part.vertices);
        if (material != materials.end()) std::replace(vertex, end, -1, material->second);
        vertex = end;
    }
    if (std::all_of(mesh.colours.begin(), mesh.colours.end(), [](int32_t c) { return c < 0; })) {
        mesh.colours.clear();
    } else if (materials.empty()) {
        mesh.materials.clear();
    }
}

}  // namespace

Mesh read_mesh(const std::string& file, double unit, const Place& asked_at,
               const std::stop_token& stop) {
    const auto refused = [&](const std::string& why, const std::string& remedy) {
        return Error(asked_at, "file", "the mesh " + file + " " + why, remedy);
    };
    if (!is_there(file)) {
        throw Error(asked_at, "file", "there is no mesh " + file,
                    "Give its path relative to the scene file, or put the mesh there.");
    }
    std::string bytes = [&] {
        try {
            return read_bytes(file, kLargestFile);
        } catch (const Error& e) {
            throw refused(e.problems().front().what, e.problems().front().remedy);
        }
    }();
    const std::string format = format_of(file);
    if (format.empty()) {
        throw refused("cannot be read: its name ends neither in .obj nor in .stl, .ply or .off",
                      kRemedy);
    }
    const std::string checksum = checksum_of(bytes);
    MeshText text = tidy(std::move(bytes), format);
    if (!text.fault.empty()) throw refused(text.fault, kRemedy);
    bytes = std::move(text.bytes);
    const CompanionTask task{
        kReader, {format}, limits_for(bytes.size()), "reading the mesh " + file, kRemedy, asked_at,
        "file",  stop};
    const std::optional<std::string> answer = run_companion(task, bytes);
    std::optional<MeshParts> read = answer ? mesh_of(*answer, unit, text.from) : std::nullopt;
    const bool none = !read || read->mesh.faces.empty();
    if (const std::string missing = none ? missing_in(bytes, format) : ""; !missing.empty())
        throw refused(missing, kRemedy);
    if (!read) throw refused("cannot be read as a mesh", kRemedy);
    Mesh& mesh = read->mesh;
    mesh.checksum = checksum;
    for (const Vec3& v : mesh.vertices) {
        if (!v.allFinite()) throw refused("has a vertex that is not a number", "Export it again.");
    }
    if (mesh.faces.empty()) throw refused("has no triangles", "Export it again with its surface.");
    // STL defines no colours, and each program uses the spare bytes differently
    if (format == "stl") std::fill(mesh.colours.begin(), mesh.colours.end(), -1);
    if (format == "obj") mesh.materials = materials_of(file, bytes);
    add_materials(*read);
    return std::move(mesh);
}

bool is_unit_known(const Place& place, const Diagnostics& diagnostics) {
    const std::vector<Problem>& told = diagnostics.problems();
    return std::none_of(told.begin(), told.end(), [&](const Problem& problem) {
        return problem.severity == Severity::error && problem.key == "unit" &&
               problem.place.file == place.file && problem.place.line == place.line;
    });
}

}  // namespace dihaptic::scene
