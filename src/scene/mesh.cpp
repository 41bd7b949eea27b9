#include "scene/mesh.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <filesystem>

namespace dihaptic::scene {

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
        throw Error(asked_at, "file",
                    "the mesh " + file + " cannot be read: " + importer.GetErrorString(),
                    "Export it again as OBJ, STL or PLY.");
    }
    Mesh mesh;
    for (unsigned m = 0; m < in->mNumMeshes; ++m) {
        const aiMesh& part = *in->mMeshes[m];
        const int offset = static_cast<int>(mesh.vertices.size());
        for (unsigned i = 0; i < part.mNumVertices; ++i) {
            const aiVector3D& v = part.mVertices[i];
            mesh.vertices.push_back(unit * Vec3(v.x, v.y, v.z));
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
        throw Error(asked_at, "file", "the mesh " + file + " has no triangles",
                    "Export it again with its surface.");
    }
    return mesh;
}

}  // namespace dihaptic::scene
