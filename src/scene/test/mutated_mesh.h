// Damaged meshes for tests: the shipped meshes in each format that can be read, with changed bytes,
// truncated ends, lost or doubled lines, impossible numbers, and headers that announce too much.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <random>

#include "scene/hull.h"
#include "scene/mesh.h"
#include "testing/files.h"

namespace dihaptic::scene {

struct MeshFile {
    std::string ending;  ///< ".ply"
    std::string bytes;
};

/// Returns the bytes of a value as they are in memory.
template <class Value>
std::string raw(Value value) {
    std::string out(sizeof(Value), '\0');
    std::memcpy(out.data(), &value, sizeof(Value));
    return out;
}

inline std::string obj_of(const Mesh& mesh) {
    std::string out = "o thing\n";
    for (const Vec3& v : mesh.vertices) out += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
    for (const auto& f : mesh.faces)
        out += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
    return out;
}

inline std::string off_text(const Mesh& mesh) {
    std::string out = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.faces.size());
    for (const Vec3& v : mesh.vertices) out += fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
    for (const auto& f : mesh.faces) out += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
    return out;
}

inline std::string stl_of(const Mesh& mesh, bool binary) {
    std::string out =
        binary ? std::string(80, ' ') + raw<uint32_t>(mesh.faces.size()) : "solid t\n";
    for (const auto& f : mesh.faces) {
        out += binary ? std::string(12, '\0') : "facet normal 0 0 0\nouter loop\n";
        for (const int i : f) {
            const Vec3& v = mesh.vertices[static_cast<size_t>(i)];
            if (!binary) out += fmt::format("vertex {} {} {}\n", v.x(), v.y(), v.z());
            for (int axis = 0; binary && axis < 3; ++axis) out += raw(static_cast<float>(v[axis]));
        }
        out += binary ? std::string(2, '\0') : "endloop\nendfacet\n";
    }
    return binary ? out : out + "endsolid t\n";
}

/// Returns a mesh as a PLY file, either in text form or in binary form with either byte order.
inline std::string ply_of(const Mesh& mesh, const std::string& format) {
    std::string out = fmt::format(
        "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
        "z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        format, mesh.vertices.size(), mesh.faces.size());
    const auto add = [&](auto value) {
        std::string bytes = raw(value);
        if (format == "binary_big_endian") std::reverse(bytes.begin(), bytes.end());
        out += format == "ascii" ? fmt::format("{} ", value) : bytes;
    };
    const auto end = [&] { out += format == "ascii" ? "\n" : ""; };
    for (const Vec3& v : mesh.vertices) {
        for (const double x : v) add(static_cast<float>(x));
        end();
    }
    for (const auto& f : mesh.faces) {
        out += format == "ascii" ? "3 " : "\x03";
        for (const int i : f) add(i);
        end();
    }
    return out;
}

/// The shipped meshes in all formats.
inline std::vector<MeshFile> whole_meshes() {
    std::vector<MeshFile> out;
    for (const char* name : {"cup", "fingertip", "hook", "pad", "spatula", "stone", "stylus"}) {
        const Mesh mesh = read_mesh(fmt::format("meshes/{}.obj", name), 1, {});
        out.push_back({".obj", obj_of(mesh)});
        out.push_back({".off", off_text(mesh)});
        out.push_back({".stl", stl_of(mesh, false)});
        out.push_back({".stl", stl_of(mesh, true)});
        for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
            out.push_back({".ply", ply_of(mesh, format)});
    }
    return out;
}

/// Damages files. The same seed causes the same damage on every machine.
class Damage {
  public:
    explicit Damage(uint64_t number) : engine_(number) {}
    size_t below(size_t n) { return n == 0 ? 0 : engine_() % n; }

    void to(MeshFile& file) {
        for (size_t times = 1 + below(3); times > 0; --times) once(file);
    }

  private:
    void once(MeshFile& file) {
        std::string& bytes = file.bytes;
        switch (below(8)) {
            case 0:
                for (size_t n = 1 + below(8); n > 0 && !bytes.empty(); --n)
                    bytes[below(bytes.size())] = static_cast<char>(below(256));
                break;
            case 1:
                bytes.resize(below(bytes.size() + 1));
                break;
            case 2:
                line(bytes, true);
                break;
            case 3:
                line(bytes, false);
                break;
            case 4:
                number(bytes, bytes.size());
                break;
            case 5:
                head(file);
                break;
            case 6:
                bytes.insert(below(bytes.size() + 1),
                             bytes.substr(below(bytes.size() + 1), below(200)));
                break;
            default:
                word(bytes, below(bytes.size()));
        }
    }

    /// Duplicates or removes a line.
    void line(std::string& bytes, bool twice) {
        const size_t from = bytes.find('\n', below(bytes.size()));
        if (from == std::string::npos) return;
        const size_t to = bytes.find('\n', from + 1);
        const std::string text = bytes.substr(from, to - from);
        if (twice) bytes.insert(from, text);
        if (!twice) bytes.erase(from, text.size());
    }

    /// Replaces a number in the text before `end` with a number that no mesh contains.
    void number(std::string& bytes, size_t end) {
        static constexpr std::array kExtreme{
            "1e38", "-1e39", "1e308", "1e-45",      "nan",        "-inf",
            "-1",   "0",     "2",     "4294967295", "2147483648", "99999999999999999999"};
        const size_t from = bytes.find_first_of("0123456789", below(end));
        if (from >= end) return;
        const size_t to = bytes.find_first_not_of("0123456789.e-", from);
        bytes.replace(from, to - from, kExtreme[below(kExtreme.size())]);
    }

    void word(std::string& bytes, size_t at) {
        static constexpr std::array<uint32_t, 7> kExtreme{0xffffffff, 0x7fffffff, 0x80000000, 0,
                                                          0x7f800000, 0x7fc00000, 0x00ffffff};
        if (at + 4 <= bytes.size()) bytes.replace(at, 4, raw(kExtreme[below(kExtreme.size())]));
    }

    /// Changes a count in the header of the file.
    void head(MeshFile& file) {
        const bool binary_stl = file.ending == ".stl" && !file.bytes.starts_with("solid");
        if (binary_stl) return word(file.bytes, 80);
        const size_t end = file.bytes.find("end_header");
        number(file.bytes, std::min({end, file.bytes.size(), size_t{200}}));
    }

    std::mt19937_64 engine_;
};

/// How many damaged files had each outcome.
struct Outcomes {
    int read = 0;
    int refused = 0;
    int crashed = 0;
    int time = 0;
    int memory = 0;
    int output = 0;
    double slowest = 0;               ///< [s]
    std::vector<std::string> untold;  ///< messages that lack the mesh's name, its place or a remedy

    int all() const { return read + refused + crashed + time + memory + output; }
    void add(const Outcomes& other) {
        read += other.read;
        refused += other.refused;
        crashed += other.crashed;
        time += other.time;
        memory += other.memory;
        output += other.output;
        slowest = std::max(slowest, other.slowest);
        untold.insert(untold.end(), other.untold.begin(), other.untold.end());
    }
    std::string text() const {
        return fmt::format(
            "{} read, {} refused; ended: {} by a crash, {} by time, {} by memory, {} by output; "
            "the slowest took {:.1f} s",
            read, refused, crashed, time, memory, output, slowest);
    }
};

inline void count_message(const Problem& problem, const std::string& file, Outcomes& out) {
    const auto says = [&](const char* text) {
        return problem.what.find(text) != std::string::npos;
    };
    const bool told = says(file.c_str()) && problem.place.line == 7 && !problem.remedy.empty();
    if (!told) out.untold.push_back(problem.text());
    if (says("crashed")) {
        ++out.crashed;
    } else if (says("of memory")) {
        ++out.memory;
    } else if (says("wrote more")) {
        ++out.output;
    } else if (says("took more")) {
        ++out.time;
    } else {
        ++out.refused;
    }
}

/// Reads every `stride`th damaged file from `first` to `end`, in the way in which a mesh named by a
/// scene is read.
inline Outcomes read_damaged(const std::vector<MeshFile>& whole, uint64_t first, uint64_t end,
                             uint64_t stride = 1) {
    const testing::TemporaryFolder folder;
    Outcomes out;
    for (uint64_t number = first; number < end; number += stride) {
        MeshFile damaged = whole[number % whole.size()];
        Damage(number).to(damaged);
        const std::string file =
            folder.write(fmt::format("{}{}", number, damaged.ending), damaged.bytes);
        const auto begin = std::chrono::steady_clock::now();
        try {
            const Mesh mesh = read_mesh(file, 1e-3, {"scene.yaml", 7});
            const Hull hull = convex_hull(mesh.vertices);
            integrate(hull.vertices, hull.faces);
            ++out.read;
        } catch (const Error& e) {
            count_message(e.problems().front(), file, out);
        }
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        out.slowest = std::max(out.slowest, took.count());
        std::filesystem::remove(file);
    }
    return out;
}

}  // namespace dihaptic::scene
