#include "scene/mesh.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <filesystem>
#include <fstream>

namespace dihaptic::scene {

namespace {

/// What an OBJ file lacks to be a surface, which the importer tells in its own terms or not at all;
/// "" when it lacks nothing, or is of another format.
std::string missing_in(const std::string& file) {
    if (!file.ends_with(".obj") && !file.ends_with(".OBJ")) return "";
    std::ifstream in(file);
    size_t vertices = 0;
    size_t faces = 0;
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("v ")) ++vertices;
        if (line.starts_with("f ")) ++faces;
    }
    const auto counted = [&](size_t n, const char* one, const char* many) {
        return n == 0 ? fmt::format("no {}", many) : fmt::format("{} {}", n, n == 1 ? one : many);
    };
    if (vertices >= 4 && faces >= 4) return "";
    return fmt::format("has {} ('v') and {} ('f'), where a solid needs at least four of each",
                       counted(vertices, "vertex", "vertices"), counted(faces, "face", "faces"));
}

}  // namespace

Mesh read_mesh(const std::string& file, double unit, const Place& asked_at) {
    if (!std::filesystem::is_regular_file(file)) {
        throw Error(asked_at, "file", "there is no mesh " + file,
                    "Give its path relative to the scene file, or put the mesh there.");
    }
    Assimp::Importer importer;
    const aiScene* in =
        importer.ReadFile(file, aiProcess_Triangulate | aiProcess_JoinIdenticalVertices |
                                    aiProcess_PreTransformVertices);
    if (in == nullptr) {
        const std::string missing = missing_in(file);
        throw Error(
            asked_at, "file",
            "the mesh " + file + (missing.empty() ? " cannot be read as a mesh" : " " + missing),
            "Export it again as OBJ, STL or PLY, with its surface.");
    }
    Mesh mesh;
    for (unsigned m = 0; m < in->mNumMeshes; ++m) {
        const aiMesh& part = *in->mMeshes[m];
        const int offset = static_cast<int>(mesh.vertices.size());
        for (unsigned i = 0; i < part.mNumVertices; ++i) {
            const aiVector3D& v = part.mVertices[i];
            mesh.vertices.push_back(unit * Vec3(v.x, v.y, v.z));
            if (!mesh.vertices.back().allFinite()) {
                throw Error(asked_at, "file",
                            "the mesh " + file + " has a vertex that is no number",
                            "Export it again.");
            }
        }
        for (unsigned i = 0; i < part.mNumFaces; ++i) {
            const aiFace& face = part.mFaces[i];
            if (face.mNumIndices != 3) continue;  // points and lines bound no volume
            mesh.faces.push_back({offset + static_cast<int>(face.mIndices[0]),
                                  offset + static_cast<int>(face.mIndices[1]),
                                  offset + static_cast<int>(face.mIndices[2])});
        }
    }
    if (mesh.faces.empty()) {
        const std::string missing = missing_in(file);
        throw Error(asked_at, "file",
                    "the mesh " + file + " " + (missing.empty() ? "has no triangles" : missing),
                    "Export it again with its surface.");
    }
    return mesh;
}

}  // namespace dihaptic::scene
