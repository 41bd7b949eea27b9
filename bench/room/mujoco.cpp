// Runs a scene in MuJoCo, as a peer of our own solvers: writes it as MJCF, and steps it.
#include "base/number.h"
#include "bench/hinges.h"
#include "bench/simulator.h"

#ifdef DIHAPTIC_PEERS
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <memory>
#include <span>
#endif

namespace dihaptic::bench {

#ifdef DIHAPTIC_PEERS

namespace {

struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
    void operator()(mjVFS* files) const {
        mj_deleteVFS(files);
        delete files;
    }
};
template <class T>
using Owned = std::unique_ptr<T, Delete>;

/// Boxes are shrunk by this on each side: if boxes touch exactly, this version of MuJoCo
/// reports contacts centimetres deep, and throws cards and stacks apart.
constexpr double kDrawnIn = 5e-6;  // [m]

/// Attributes that differ from MuJoCo's defaults.
struct Choice {
    std::string option;
    std::string geom;
};

std::string text(const Vec3& v) {
    return fmt::format("{} {} {}", v.x(), v.y(), v.z());
}

/// MuJoCo uses the larger friction of a pair; in the bench's scenes all bodies have the same.
std::string geometry(const scene::Body& body, size_t index) {
    switch (body.shape.kind) {
        case scene::ShapeKind::box:
            return fmt::format("<geom type='box' size='{}' friction='{}'/>",
                               text(body.shape.size / 2 - Vec3::Constant(kDrawnIn)), body.friction);
        case scene::ShapeKind::mesh:
            return fmt::format("<geom type='mesh' mesh='mesh{}' friction='{}'/>", index,
                               body.friction);
        case scene::ShapeKind::capsule:
            return fmt::format("<geom type='capsule' size='{} {}' friction='{}'/>",
                               body.shape.radius, body.shape.length / 2, body.friction);
        case scene::ShapeKind::plane:
            return fmt::format("<geom type='plane' size='1 1 1' friction='{}'/>", body.friction);
        default:
            throw Error("MuJoCo gets only boxes, capsules, meshes and planes", "Use only these.");
    }
}

std::string joints(const scene::Body& body) {
    if (!body.moves_at_all()) return "";
    if (body.moves == scene::Axes::xyz && body.turns == scene::Axes::xyz) return "<freejoint/>";
    if (body.turns != scene::Axes::none)
        throw Error("MuJoCo gets no bodies with only some axes of rotation", "Use all or none.");
    std::string out;
    for (int axis = 0; axis < 3; ++axis) {
        if (!scene::contains(body.moves, axis)) continue;
        out += fmt::format("<joint type='slide' axis='{}'/>", text(Vec3::Unit(axis)));
    }
    return out;
}

std::string inertia(const scene::Body& body) {
    if (!body.moves_at_all()) return "";
    const scene::VolumeIntegrals unit = scene::integrate(body.shape);
    const double mass = scene::mass(body);
    const Mat3 I = mass / unit.volume * unit.inertia;
    return fmt::format("<inertial pos='{}' mass='{}' fullinertia='{} {} {} {} {} {}'/>",
                       text(unit.centre), mass, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2),
                       I(1, 2));
}

/// A body with all its children, in the frame of its parent. Each body's name is its index.
std::string element(const scene::Scene& scene, std::span<const Hinge> hinges, size_t index,
                    const Pose& X_WP) {
    const scene::Body& body = scene.bodies[index];
    const Pose X_WB = body.pose();
    const Pose X_PB = X_WP.inverse() * X_WB;
    std::string joint = joints(body);
    std::string children;
    for (const Hinge& hinge : hinges) {
        if (hinge.body == index)
            joint = fmt::format("<joint type='hinge' pos='{}' axis='{}'/>",
                                text(X_WB.inverse() * hinge.p_W),
                                text(X_WB.R.conjugate() * hinge.axis_W));
        if (hinge.parent == index) children += element(scene, hinges, hinge.body, X_WB);
    }
    return fmt::format("<body name='{}' pos='{}' quat='{} {} {} {}'>{}{}{}{}</body>", index,
                       text(X_PB.p), X_PB.R.w(), X_PB.R.x(), X_PB.R.y(), X_PB.R.z(), joint,
                       inertia(body), geometry(body, index), children);
}

std::string mjcf(const scene::Scene& scene, const Choice& choice) {
    const std::vector<Hinge> hinges = hinges_of(scene);
    std::string meshes;
    std::string bodies;
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        const scene::Body& body = scene.bodies[i];
        if (body.shape.kind == scene::ShapeKind::mesh) {
            meshes += fmt::format("<mesh name='mesh{}' vertex='", i);
            for (const Vec3& v : body.shape.hull.vertices) meshes += text(v) + " ";
            meshes += "'/>";
        }
        const bool hangs = std::any_of(hinges.begin(), hinges.end(), [&](const Hinge& hinge) {
            return hinge.body == i && hinge.parent;
        });
        if (!hangs) bodies += element(scene, hinges, i, {});
    }
    // meshes get one contact per pair unless multiccd is on; a face needs four
    return fmt::format(
        "<mujoco><option timestep='{}' gravity='{}' cone='elliptic' {}><flag multiccd='enable'/>"
        "</option><default><geom {}/></default><asset>{}</asset><worldbody>{}</worldbody></mujoco>",
        kStep, text(scene.gravity), choice.option, choice.geom, meshes, bodies);
}

Owned<mjModel> load(const std::string& xml) {
    constexpr const char* kFile = "scene.xml";
    const Owned<mjVFS> files(new mjVFS);
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), kFile, static_cast<int>(xml.size()));
    std::copy(xml.begin(), xml.end(),
              static_cast<char*>(files->filedata[mj_findFileVFS(files.get(), kFile)]));
    std::array<char, 1000> error{};
    Owned<mjModel> model(
        mj_loadXML(kFile, files.get(), error.data(), static_cast<int>(error.size())));
    if (!model)
        throw Error(fmt::format("MuJoCo refuses a scene: {}", error.data()), "Correct mujoco.cpp.");
    return model;
}

void run(const Choice& choice, const Trial& trial, int steps, const Watch& watch) {
    // by default MuJoCo writes a log file to the working folder, and waits for a key before it
    // exits
    mju_user_warning = [](const char*) {};
    mju_user_error = [](const char* what) {
        fmt::print(stderr, "MuJoCo: {}\n", what);
        std::_Exit(1);
    };
    const Owned<mjModel> model = load(mjcf(trial.scene, choice));
    const Owned<mjData> data(mj_makeData(model.get()));
    std::vector<int> index;  // indices of MuJoCo's bodies, in the scene's order
    for (size_t b = 0; b < trial.scene.bodies.size(); ++b)
        index.push_back(mj_name2id(model.get(), mjOBJ_BODY, number_text(b).c_str()));
    std::vector<Pose> X_WB(trial.scene.bodies.size());
    for (int i = 0; i < steps; ++i) {
        const double before = data->time;
        std::fill_n(data->xfrc_applied, 6 * model->nbody, 0.0);
        trial.push(i, [&](const Trial::Push& push) {
            mju_addTo3(data->xfrc_applied + 6 * index[push.body], push.force_W.data());
        });
        mj_step(model.get(), data.get());
        if (data->time <= before) {  // MuJoCo met a bad number, and restarted
            for (Pose& X : X_WB) X.p.setConstant(std::numeric_limits<double>::infinity());
            watch(X_WB);
            return;
        }
        mj_kinematics(model.get(), data.get());  // poses after the step, not before
        for (size_t b = 0; b < X_WB.size(); ++b) {
            const double* const p = data->xpos + 3 * index[b];
            const double* const q = data->xquat + 4 * index[b];
            X_WB[b] = {Quat(q[0], q[1], q[2], q[3]), Vec3(p[0], p[1], p[2])};
        }
        if (!watch(X_WB)) return;
    }
}

Simulator simulator(const std::string& name, const Choice& choice) {
    return {name,
            [choice](const Trial& trial, int steps, const Watch& watch) {
                run(choice, trial, steps, watch);
            },
            scene::ShapeKind::plane};
}

}  // namespace

std::vector<Simulator> mujoco_simulators() {
    // settings for small, hard objects, which make contacts stiffer or reduce the creep of friction
    const std::string stiff = "solref='0.005 1'";
    return {simulator("mujoco", {}), simulator("mujoco_recipe", {"impratio='10'", ""}),
            simulator("mujoco_stiff", {"impratio='100' tolerance='1e-12'", stiff}),
            simulator("mujoco_noslip", {"noslip_iterations='10'", stiff})};
}

std::vector<Simulator> mujoco_jointed_simulators() {
    return {simulator("mujoco", {}), simulator("mujoco_rk4", {"integrator='RK4'", ""})};
}

#else

std::vector<Simulator> mujoco_simulators() {
    return {};
}

std::vector<Simulator> mujoco_jointed_simulators() {
    return {};
}

#endif

}  // namespace dihaptic::bench
