#include "task/perturbation.h"

#include "task/lookup.h"

namespace dihaptic::task {
namespace {

constexpr double kSmallAxis = 1e-9;

Vec3 axis_of(const std::optional<Vec3>& axis, const Place& place, Diagnostics& diagnostics) {
    if (axis && axis->norm() > kSmallAxis) return axis->normalized();
    diagnostics.error(place, "axis", axis ? "has no direction" : "is missing",
                      "Write it in world axes, e.g. axis: [0, 0, 1].");
    return Vec3::UnitZ();
}

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

}  // namespace

Perturbation::Perturbation(const PerturbationSpec& spec, const std::vector<Region>& regions,
                           const scene::Scene& scene, Diagnostics& diagnostics) {
    if (spec.visual) look_up_map(*spec.visual, regions, scene, diagnostics);
    if (spec.body) look_up_body(*spec.body, scene, diagnostics);
    if (spec.field) look_up_field(*spec.field, regions, scene, diagnostics);
    if (!spec.visual && !spec.body && !spec.field) {
        diagnostics.error(spec.place, spec.name, "perturbs nothing",
                          "Give it visual, body or field.");
    }
}

void Perturbation::look_up_map(const VisualSpec& visual, const std::vector<Region>& regions,
                               const scene::Scene& scene, Diagnostics& diagnostics) {
    const auto region = [&](const std::string& name, const char* key) {
        return look_up(names_of(regions), name, visual.place, key, "no region", diagnostics);
    };
    Map& map = map_.emplace(Map{});
    map.moves = moves_of(visual, diagnostics);
    map.object = scene.object_index();
    map.about = region(visual.about, "about");
    if (!visual.toward.empty()) map.toward = region(visual.toward, "toward");
    map.scale = visual.scale;
    if (visual.axis || visual.angle != 0)
        map.axis = axis_of(visual.axis, visual.place, diagnostics);
    map.angle = visual.angle;
    map.size = visual.size;
    if (map.moves & servo::kMovesObject && map.object < 0) {
        diagnostics.error(visual.place, "moves", "the scene has no object that can move",
                          "Leave out object.");
    }
    if (map.size != 1 && (map.moves & servo::kMovesObject) == 0) {
        diagnostics.error(visual.place, "size", "is the object's, which is not moved",
                          "Add object to moves.");
    }
    if (map.toward >= 0 && (map.angle != 0 || map.scale != Vec3::Ones())) {
        diagnostics.error(visual.place, "toward",
                          "what is shown on a line can be neither rotated nor scaled",
                          "Leave out angle_deg and scale, or toward.");
    }
}

void Perturbation::look_up_body(const BodySpec& body, const scene::Scene& scene,
                                Diagnostics& diagnostics) {
    servo::PropertiesFrame& out = properties_.emplace();
    out.body =
        look_up(names_of(scene.bodies), body.body, body.place, "body", "no body", diagnostics);
    if (out.body >= 0 && !scene.bodies[static_cast<size_t>(out.body)].moves_at_all()) {
        diagnostics.error(body.place, "body", "'" + body.body + "' cannot move",
                          "Name a body that can.");
    }
    out.mass_scale = body.density_scale * body.mass_scale;
    out.weight_scale = body.density_scale * body.weight_scale;
    out.turning_scale = body.density_scale;
    out.friction_scale = body.friction_scale;
}

void Perturbation::look_up_field(const ForceFieldSpec& given, const std::vector<Region>& regions,
                                 const scene::Scene& scene, Diagnostics& diagnostics) {
    const auto region = [&](const std::string& name, const char* key) {
        return look_up(names_of(regions), name, given.place, key, "no region", diagnostics);
    };
    ForceField& field = field_.emplace(ForceField{});
    field.kind = given.kind;
    field.damping = given.damping;
    field.stiffness = given.stiffness;
    std::vector<std::string> things = names_of(scene.bodies);
    const int bodies = static_cast<int>(things.size());
    for (const scene::Finger& finger : scene.fingers) things.push_back(finger.name);
    field.index = look_up(things, given.on, given.place, "on", "no finger or body", diagnostics);
    if (field.index >= bodies) field.finger = field.index - bodies;
    if (field.kind == FieldKind::curl) field.axis = axis_of(given.axis, given.place, diagnostics);
    if (field.kind == FieldKind::channel) {
        field.from = region(given.from, "from");
        field.to = region(given.to, "to");
        if (given.stiffness <= 0) {
            diagnostics.error(given.place, "stiffness", "a channel needs one",
                              "Add e.g. stiffness_N_m: 1000.");
        }
    } else if (given.damping == 0) {
        diagnostics.error(given.place, "damping", "is missing: the field would do nothing",
                          "Add e.g. damping_Ns_m: 10.");
    }
}

std::optional<Vec3> Perturbation::axis() const {
    if (map_ && map_->angle != 0) return map_->axis;
    if (field_ && field_->kind == FieldKind::curl) return field_->axis;
    return {};
}

std::optional<Perturbation::OnHandle> Perturbation::on_handle() const {
    if (!field_ || field_->finger < 0) return {};
    return OnHandle{field_->finger, field_->damping, field_->stiffness};
}

Vec3 Perturbation::force(double share, std::span<const Vec3> regions_W, const Vec3& p_W,
                         const Vec3& v_W) const noexcept {
    const ForceField& field = *field_;
    switch (field.kind) {
        case FieldKind::viscous:
            return -share * field.damping * v_W;
        case FieldKind::curl:
            return share * field.damping * field.axis.cross(v_W);
        case FieldKind::channel: {
            const Vec3& from = regions_W[static_cast<size_t>(field.from)];
            const Vec3 way = regions_W[static_cast<size_t>(field.to)] - from;
            const double length = way.norm();
            if (length <= 0) return Vec3::Zero();
            const Vec3 along = way / length;
            const Vec3 arm = p_W - from;
            const Vec3 off = arm - arm.dot(along) * along;
            const Vec3 across = v_W - v_W.dot(along) * along;
            return -share * (field.stiffness * off + field.damping * across);
        }
    }
    return Vec3::Zero();
}

void Perturbation::order(double share, std::span<const Vec3> regions_W, const servo::Frame& last,
                         std::span<const haptics::Handle> handles,
                         servo::TaskFrame& out) const noexcept {
    if (map_) {
        const Map& map = *map_;
        servo::VisualMap shown;
        shown.moves = map.moves;
        shown.object = map.object;
        shown.p_WC = regions_W[static_cast<size_t>(map.about)];
        shown.scale = Vec3::Ones() + share * (map.scale - Vec3::Ones());
        shown.R = Quat(Eigen::AngleAxisd(share * map.angle, map.axis));
        shown.size = 1 + share * (map.size - 1);
        if (map.toward >= 0) {
            const Vec3 way = regions_W[static_cast<size_t>(map.toward)] - shown.p_WC;
            if (way.norm() > 0) shown.along_W = way.normalized();
        }
        add(out.visual, shown);
    }
    if (properties_) {
        servo::PropertiesFrame now = *properties_;
        now.mass_scale = Vec3::Ones() + share * (now.mass_scale - Vec3::Ones());
        now.weight_scale = 1 + share * (now.weight_scale - 1);
        now.turning_scale = 1 + share * (now.turning_scale - 1);
        now.friction_scale = 1 + share * (now.friction_scale - 1);
        add(out.properties, now);
    }
    if (field_ && field_->finger >= 0) {
        const haptics::Handle& handle = handles[static_cast<size_t>(field_->finger)];
        add(out.loads,
            {field_->index, force(share, regions_W, handle.p_WH, handle.v_WH), Vec3::Zero()});
    } else if (field_ && last.sequence >= 0) {
        const servo::BodyFrame& body = last.bodies[static_cast<size_t>(field_->index)];
        add(out.loads,
            {field_->index, force(share, regions_W, body.X_WB.p, body.v_WB), Vec3::Zero()});
    }
}

}  // namespace dihaptic::task
