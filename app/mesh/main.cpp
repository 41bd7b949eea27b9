// dihaptic-mesh FORMAT: reads a mesh (obj, stl, ply or off) from standard input and writes its
// triangles to standard output. The output is a line "dihaptic mesh 2", followed by the numbers of
// vertices, faces and parts, as 64-bit integers; the vertices, as three doubles each; the faces, as
// three 32-bit indices each; the colours of the vertices, as 32-bit integers with the value 65536
// red + 256 green + blue, or -1 if there is no colour; the number of vertices in each part, as
// 64-bit integers; and the name of the material of each part, terminated by a zero byte. Numbers
// are in this machine's byte order. The program dihaptic calls this program, with resource limits,
// because the library that reads meshes crashes on damaged files; there is no need to call it by
// hand.
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "ears.h"

namespace {

/// Exit status of the program (base/companion.h).
enum Status : int { kDone = 0, kRefused = 1, kOutOfMemory = 3 };

/// Lets the library read the mesh, but not other files to which the mesh refers: materials would
/// change the order of the vertices, and thus the felt surface.
class OneFile final : public Assimp::MemoryIOSystem {
  public:
    OneFile(const std::string& bytes, std::string name)
        : MemoryIOSystem(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), nullptr),
          name_(std::move(name)) {}
    bool Exists(const char* file) const override { return name_ == file; }
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        return name_ == file ? MemoryIOSystem::Open(file, mode) : nullptr;
    }

  private:
    std::string name_;
};

struct Surface {
    std::vector<std::array<double, 3>> vertices;
    std::vector<std::array<uint32_t, 3>> faces;
    std::vector<int32_t> colours;
    std::vector<uint64_t> parts;
    std::string materials;
};

/// Adds the vertex colours of a part. In files, colour values range from 0 to 1 or, as in some OFF
/// files, from 0 to 255.
void add_colours(const aiMesh& part, std::vector<int32_t>& out) {
    const aiColor4D* const colours = part.mColors[0];
    if (colours == nullptr) {
        out.insert(out.end(), part.mNumVertices, -1);
        return;
    }
    const bool is_whole = std::any_of(colours, colours + part.mNumVertices,
                                      [](const auto& c) { return c.r > 1 || c.g > 1 || c.b > 1; });
    const auto byte = [&](float share) {
        const float value = is_whole ? share : 255 * share;
        return value > 0 ? static_cast<int32_t>(std::lround(std::min(value, 255.F))) : 0;
    };
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
        const aiColor4D& c = colours[i];
        out.push_back(byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b));
    }
}

/// Adds the triangles of a face. Points and lines are skipped, because they do not bound a volume.
void add_face(const aiFace& face, const aiMesh& part, uint32_t offset, Surface& out) {
    if (face.mNumIndices == 3) {
        out.faces.push_back(
            {offset + face.mIndices[0], offset + face.mIndices[1], offset + face.mIndices[2]});
        return;
    }
    std::vector<dihaptic::mesh::Corner> corners;
    for (unsigned i = 0; i < face.mNumIndices; ++i) {
        const aiVector3D& v = part.mVertices[face.mIndices[i]];
        corners.push_back({v.x, v.y, v.z});
    }
    for (const auto& [a, b, c] : dihaptic::mesh::ears(corners))
        out.faces.push_back(
            {offset + face.mIndices[a], offset + face.mIndices[b], offset + face.mIndices[c]});
}

/// The total number of triangles in the faces.
size_t count_triangles(const aiScene& scene) {
    size_t out = 0;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        for (unsigned i = 0; i < scene.mMeshes[m]->mNumFaces; ++i)
            out += std::max(scene.mMeshes[m]->mFaces[i].mNumIndices, 2U) - 2;
    }
    return out;
}

Surface surface_of(const aiScene& scene) {
    Surface out;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& part = *scene.mMeshes[m];
        const auto offset = static_cast<uint32_t>(out.vertices.size());
        for (unsigned i = 0; i < part.mNumVertices; ++i) {
            const aiVector3D& v = part.mVertices[i];
            out.vertices.push_back({v.x, v.y, v.z});
        }
        for (unsigned i = 0; i < part.mNumFaces; ++i) add_face(part.mFaces[i], part, offset, out);
        add_colours(part, out.colours);
        out.parts.push_back(part.mNumVertices);
        if (part.mMaterialIndex < scene.mNumMaterials)
            out.materials += scene.mMaterials[part.mMaterialIndex]->GetName().C_Str();
        out.materials += '\0';
    }
    return out;
}

std::string standard_input() {
    std::string bytes;
    std::array<char, 1 << 16> block{};
    while (const size_t size = std::fread(block.data(), 1, block.size(), stdin))
        bytes.append(block.data(), size);
    return bytes;
}

template <class Items>
bool write(const Items& items) {
    return std::fwrite(items.data(), sizeof(items[0]), items.size(), stdout) == items.size();
}

Status read(const std::string& format) {
    const std::string bytes = standard_input();
    const std::string name = AI_MEMORYIO_MAGIC_FILENAME "." + format;
    constexpr unsigned kJoined = aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices;
    Assimp::Importer importer;
    importer.SetIOHandler(new OneFile(bytes, name));  // the importer takes ownership
    const auto read_with = [&](unsigned steps) { return importer.ReadFile(name, steps); };
    // counted first, because the library silently drops faces that it cannot triangulate, such as
    // faces with collinear corners; STL contains only triangles
    const aiScene* scene = format == "stl" ? nullptr : read_with(kJoined);
    const size_t wanted = scene == nullptr ? 0 : count_triangles(*scene);
    scene = read_with(kJoined | aiProcess_Triangulate);
    if (scene != nullptr && format != "stl" && count_triangles(*scene) != wanted)
        scene = read_with(kJoined);
    if (scene == nullptr) return kRefused;
    const Surface surface = surface_of(*scene);
    const std::array<uint64_t, 3> counts{surface.vertices.size(), surface.faces.size(),
                                         surface.parts.size()};
    std::fputs("dihaptic mesh 2\n", stdout);
    const bool written = write(counts) && write(surface.vertices) && write(surface.faces) &&
                         write(surface.colours) && write(surface.parts) &&
                         write(surface.materials) && std::fflush(stdout) == 0;
    // destructors are not called, because they may crash on data from a damaged file
    std::_Exit(written ? kDone : kRefused);
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::cerr << "usage: dihaptic-mesh FORMAT < MESH\n";
        return kRefused;
    }
    std::set_new_handler([] { std::_Exit(kOutOfMemory); });
    return read(arguments[1]);
}
