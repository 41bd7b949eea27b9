#include "task/perturbation.h"

#include <algorithm>

#include "task/lookup.h"

namespace dihaptic::task {
namespace {

/// Bit mask of the names "proxies", "object" and "target"; an unknown name is an error and sets no
/// bit.
uint32_t moves_of(const VisualSpec& visual, Diagnostics& diagnostics) {
    const std::vector<std::string> names{"proxies", "object", "target"};
    uint32_t moves = 0;
    for (const std::string& name : visual.moves) {
        const int i = look_up(names, name, visual.place, "moves", "nothing to move", diagnostics);
        if (i >= 0) moves |= 1u << i;
    }
    return moves;
}

/// Adds the factors of a body to the list, or multiplies those that it has there.
void add_to(std::vector<frame::PropertiesFrame>& list, const frame::PropertiesFrame& now) noexcept {
    const auto same = std::find_if(list.begin(), list.end(), [&](const frame::PropertiesFrame& p) {
        return p.body == now.body;
    });
    if (same == list.end()) return add(list, now);
    same->mass_scale = same->mass_scale.cwiseProduct(now.mass_scale);
    same->weight_scale *= now.weight_scale;
    same->turning_scale *= now.turning_scale;
    same->friction_scale *= now.friction_scale;
    same->stiffness_scale *= now.stiffness_scale;
    same->restitution_scale *= now.restitution_scale;
}

void add_to(std::vector<frame::JointPropertiesFrame>& list,
            const frame::JointPropertiesFrame& now) noexcept {
    const auto same = std::find_if(list.begin(), list.end(),
                                   [&](const auto& other) { return other.joint == now.joint; });
    if (same == list.end()) return add(list, now);
    same->stiffness_scale *= now.stiffness_scale;
    same->damping_scale *= now.damping_scale;
    same->friction_scale *= now.friction_scale;
}

/// What becomes of a factor at a share.
double part_of(double share, double factor) {
    return 1 + share * (factor - 1);
}

bool displaces(const VisualSpec& visual) {
    return visual.delay != 0 || !visual.noise.isZero(0);
}

/// A map that only delays or shakes what is shown needs no centre.
bool has_centre(const VisualSpec& visual) {
    return !displaces(visual) || !visual.about.empty() || !visual.toward.empty() ||
           visual.angle != 0 || visual.scale != FormulaVec3{1, 1, 1} || visual.size != 1;
}

void check_displacing(const VisualSpec& visual, uint32_t moves, Diagnostics& diagnostics) {
    if (!displaces(visual) || (moves & (frame::kMovesProxies | frame::kMovesObject)) != 0) return;
    diagnostics.error(visual.place, visual.delay != 0 ? "delay" : "noise",
                      "is of proxies or the object, which are not moved", "Add proxies to moves.");
}

}  // namespace

Perturbation::Perturbation(const PerturbationSpec& spec, const std::vector<Region>& regions,
                           const scene::Scene& scene, Diagnostics& diagnostics) {
    if (spec.visual) look_up_map(*spec.visual, regions, scene, diagnostics);
    if (spec.body) look_up_body(*spec.body, scene, diagnostics);
    if (spec.joint) look_up_joint(*spec.joint, scene, diagnostics);
    for (const LoadSpec& load : spec.all_loads())
        loads_.emplace_back(load, regions, scene, diagnostics);
    profile_ = spec.profile;
    if (profile_ && profile_->fall > 0 && !profile_->plateau) {
        diagnostics.error(profile_->place, "fall", "when it falls is missing",
                          "Add e.g. plateau_ms: 100, the time between rise and fall.");
    }
    if (!spec.visual && !spec.body && !spec.joint && loads_.empty()) {
        diagnostics.error(spec.place, spec.name, "perturbs nothing",
                          "Give it visual, body, joint, loads or field.");
    }
    resolve({});
}

void Perturbation::resolve(std::span<const double> resolved) noexcept {
    const auto vector = [&](const std::array<Number, 3>& n) {
        return Vec3(n[0].in(resolved), n[1].in(resolved), n[2].in(resolved));
    };
    if (map_) {
        map_->scale = vector(map_->scale_as_given);
        map_->angle = map_->angle_as_given.in(resolved);
        map_->size = map_->size_as_given.in(resolved);
        map_->delay = map_->delay_as_given.in(resolved);
    }
    if (properties_) {
        const double density = properties_as_given_.density.in(resolved);
        properties_->mass_scale = density * vector(properties_as_given_.mass);
        properties_->weight_scale = density * properties_as_given_.weight.in(resolved);
        properties_->turning_scale = density;
        properties_->friction_scale = properties_as_given_.friction.in(resolved);
        properties_->stiffness_scale = properties_as_given_.stiffness.in(resolved);
        properties_->restitution_scale = properties_as_given_.restitution.in(resolved);
    }
    if (joint_) {
        joint_->stiffness_scale = joint_as_given_[0].in(resolved);
        joint_->damping_scale = joint_as_given_[1].in(resolved);
        joint_->friction_scale = joint_as_given_[2].in(resolved);
    }
    for (Load& load : loads_) load.resolve(resolved);
}

void Perturbation::look_up_map(const VisualSpec& visual, const std::vector<Region>& regions,
                               const scene::Scene& scene, Diagnostics& diagnostics) {
    const auto region = [&](const std::string& name, const char* key) {
        return look_up(names_of(regions), name, visual.place, key, "no region", diagnostics);
    };
    Map& map = map_.emplace(Map{});
    map.moves = moves_of(visual, diagnostics);
    map.object = scene.object_index();
    map.delay_as_given = visual.delay;
    map.longest_delay = visual.delay.computed() ? visual.delay.field.max : visual.delay.value;
    map.noise = visual.noise;
    if (has_centre(visual)) map.about = region(visual.about, "about");
    check_displacing(visual, map.moves, diagnostics);
    if (!visual.toward.empty()) map.toward = region(visual.toward, "toward");
    map.scale_as_given = numbers(visual.scale);
    if (visual.axis || visual.angle != 0)
        map.axis = axis_of(visual.axis, visual.place, "axis", diagnostics);
    map.angle_as_given = visual.angle;
    map.size_as_given = visual.size;
    if (map.moves & frame::kMovesObject && map.object < 0) {
        diagnostics.error(visual.place, "moves", "the scene has no object that can move",
                          "Leave out object.");
    }
    if (visual.size != 1 && (map.moves & frame::kMovesObject) == 0) {
        diagnostics.error(visual.place, "size", "is the object's, which is not moved",
                          "Add object to moves.");
    }
    if (map.toward >= 0 && (visual.angle != 0 || visual.scale != FormulaVec3{1, 1, 1})) {
        diagnostics.error(visual.place, "toward",
                          "what is shown on a line can be neither rotated nor scaled",
                          "Leave out angle_deg and scale, or toward.");
    }
}

void Perturbation::look_up_body(const BodySpec& body, const scene::Scene& scene,
                                Diagnostics& diagnostics) {
    frame::PropertiesFrame& out = properties_.emplace();
    out.body =
        look_up(names_of(scene.bodies), body.body, body.place, "body", "no body", diagnostics);
    const bool only_surface = body.mass_scale == FormulaVec3{1, 1, 1} && body.weight_scale == 1 &&
                              body.density_scale == 1;
    if (out.body >= 0 && !only_surface &&
        !scene.bodies[static_cast<size_t>(out.body)].moves_at_all()) {
        diagnostics.error(body.place, "body", "'" + body.body + "' cannot move",
                          "Name a body that can, or change its friction and surface alone.");
    }
    properties_as_given_ = {numbers(body.mass_scale), body.weight_scale,    body.density_scale,
                            body.friction_scale,      body.stiffness_scale, body.restitution_scale};
    if (out.body < 0) return;
    const scene::Surface& surface = scene.bodies[static_cast<size_t>(out.body)].surface;
    const auto needs = [&](const Formula& factor, const char* key, bool there, const char* what) {
        if (factor == 1 || there) return;
        diagnostics.error(body.place, key, "'" + body.body + "' has no " + what + " to change",
                          std::string("Give it one in the scene: surface: { ") + what + ": ... }.");
    };
    needs(body.stiffness_scale, "stiffness_scale", surface.stiffness.has_value(), "stiffness_N_m");
    needs(body.restitution_scale, "restitution_scale", surface.restitution.has_value(),
          "restitution");
}

void Perturbation::look_up_joint(const JointSpec& spec, const scene::Scene& scene,
                                 Diagnostics& diagnostics) {
    frame::JointPropertiesFrame& out = joint_.emplace();
    joint_as_given_ = {spec.stiffness_scale, spec.damping_scale, spec.friction_scale};
    out.joint = look_up(names_of(recorded_joints(scene)), spec.joint, spec.place, "joint",
                        "no joint of the scene", diagnostics);
    if (out.joint < 0) return;
    const scene::Joint& joint = scene.joints[static_cast<size_t>(out.joint)];
    const auto needs = [&](const Formula& factor, const char* key, bool there, const char* what) {
        if (factor == 1 || there) return;
        diagnostics.error(
            spec.place, key, "'" + spec.joint + "' has no " + what + " to change",
            std::string("Give the joint a ") + what + " in the scene, which this multiplies.");
    };
    needs(spec.stiffness_scale, "stiffness_scale", joint.has_spring(), "stiffness");
    needs(spec.damping_scale, "damping_scale", joint.has_damper(), "damping");
    needs(spec.friction_scale, "friction_scale", joint.friction > 0, "friction");
}

Mat3 Perturbation::field_gain() const {
    Mat3 gain = Mat3::Zero();
    for (const Load& load : loads_) gain += load.velocity_gain();
    return gain;
}

std::optional<Vec3> Perturbation::axis() const {
    if (map_ && (map_->angle != 0 || map_->angle_as_given.index >= 0)) return map_->axis;
    for (const Load& load : loads_) {
        if (const auto axis = load.axis()) return axis;
    }
    return {};
}

void Perturbation::order(double share, std::span<const Vec3> regions_W, const Motions& motions,
                         frame::TaskFrame& out) const noexcept {
    if (map_) {
        const Map& map = *map_;
        frame::VisualMap shown;
        shown.moves = map.moves;
        shown.object = map.object;
        if (map.about >= 0) shown.p_WC = regions_W[static_cast<size_t>(map.about)];
        shown.scale = Vec3::Ones() + share * (map.scale - Vec3::Ones());
        shown.R = Quat(Eigen::AngleAxisd(share * map.angle, map.axis));
        shown.size = 1 + share * (map.size - 1);
        shown.delay = share * map.delay;
        shown.noise = share * map.noise;
        if (map.toward >= 0) {
            const Vec3 way = regions_W[static_cast<size_t>(map.toward)] - shown.p_WC;
            if (way.norm() > 0) shown.along_W = way.normalized();
        }
        add(out.visual, shown);
    }
    if (properties_) {
        frame::PropertiesFrame now = *properties_;
        now.mass_scale = Vec3::Ones() + share * (now.mass_scale - Vec3::Ones());
        for (double* factor : {&now.weight_scale, &now.turning_scale, &now.friction_scale,
                               &now.stiffness_scale, &now.restitution_scale})
            *factor = part_of(share, *factor);
        add_to(out.properties, now);
    }
    if (joint_) {
        frame::JointPropertiesFrame now = *joint_;
        for (double* factor : {&now.stiffness_scale, &now.damping_scale, &now.friction_scale})
            *factor = part_of(share, *factor);
        add_to(out.joint_properties, now);
    }
    for (const Load& load : loads_) {
        for (const int thing : load.on()) {
            const Motion* const motion = motions.of(thing, load.delay());
            if (motion == nullptr) continue;
            const Wrench wrench = load.act(share, regions_W, *motion);
            add(out.loads, {thing, wrench.force, wrench.torque});
        }
    }
}

}  // namespace dihaptic::task
