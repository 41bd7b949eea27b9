#include "session/movement.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace dihaptic::session {
namespace {

constexpr double kClearance = 1.5e-3;  // clearance between a finger and the edge of the block [m]
constexpr double kThinnest = 2e-3;     // smallest width of a block [m]

/// Half extents of a proxy along the grasp axis, across it, and upward.
Vec3 half_extents(const scene::Shape& shape) {
    if (shape.kind == scene::ShapeKind::box) return shape.size / 2;
    return Vec3::Constant(scene::extent(shape) / 2);
}

/// Smallest distance of a finger from the middle, measured along the grasp axis, while the finger
/// passed the block's edge on its way to the face [m]. `half` contains the half extents of the
/// block, `reach` those of block and finger together. `side` is -1 or +1 along the axis.
double passing_distance(const std::vector<Vec3>& path, const hand::GraspSite& site,
                        const Quat& R_WB, int side, const Vec3& half, const Vec3& reach) {
    const auto at = [&](size_t i) { return Vec3(R_WB.conjugate() * (path[i] - site.centre)); };
    const auto within = [](const Vec3& p, const Vec3& extents) {
        return std::abs(p.y()) < extents.y() && std::abs(p.z()) < extents.z();
    };
    const size_t grasp =
        std::min(static_cast<size_t>(site.start * hand::Path::kRate), path.size() - 1);
    size_t s = grasp;
    while (s > 0 && within(at(s), reach)) --s;
    double nearest = side * at(s).x();
    for (; s < grasp && !within(at(s), half); ++s) nearest = std::min(nearest, side * at(s).x());
    return nearest;
}

/// Positions of the block's two faces along the grasp axis, measured from the midpoint between the
/// fingers.
struct Faces {
    double first = 0;  ///< face on the first finger's side, positive outward [m]
    double second = 0;
};

/// Places the faces so that both recorded fingers go `squeeze` beyond them. If a finger slid into
/// position along the face, as the index finger does in a precision grip, it would run into the
/// block's edge. In that case, the face on its side is moved back to the finger's path, and the
/// other finger squeezes more.
Faces fit_faces(const hand::Path& path, const hand::GraspSite& site, const Quat& R_WB,
                const Vec3& block, const scene::Scene& scene, double squeeze) {
    std::array<double, 2> wanted{};
    std::array<double, 2> most{};
    for (size_t i = 0; i < 2; ++i) {
        const Vec3 half = half_extents(scene.fingers[i].shape);
        const double touch = site.aperture / 2 - half.x();
        wanted[i] = touch + squeeze;
        const Vec3 reach = block / 2 + half + Vec3::Constant(kClearance);
        const double passing =
            passing_distance(path.p_WH[i], site, R_WB, i == 0 ? -1 : 1, block / 2, reach);
        most[i] = std::max(touch, passing - half.x() - kClearance);
    }
    std::array<double, 2> face{};
    for (size_t i = 0; i < 2; ++i) {
        const size_t other = 1 - i;
        const double given_up = std::max(0.0, wanted[other] - most[other]);
        face[i] = std::min(wanted[i] + given_up, most[i]);
    }
    return {face[0], face[1]};
}

/// Returns the scene's box with this name, or null if there is none.
scene::Body* find_box(scene::Scene& scene, const std::string& name) {
    const int i = scene.find(name);
    if (i < 0) return nullptr;
    scene::Body& body = scene.bodies[static_cast<size_t>(i)];
    return body.shape.kind == scene::ShapeKind::box ? &body : nullptr;
}

/// Finds the grasp in the movement. If there is none, reports an error and returns nullopt.
std::optional<hand::GraspSite> grasp_of(const hand::Path& path, const task::MovementSpec& spec,
                                        const std::string& file, const Place& asked_at,
                                        Diagnostics& diagnostics) {
    if (spec.grasp_at && *spec.grasp_at > path.duration()) {
        diagnostics.error(asked_at, "movement.grasp_at",
                          fmt::format("{:g} s is after the movement's end, at {:.3f} s",
                                      *spec.grasp_at, path.duration()),
                          "Give a time within it.");
        return std::nullopt;
    }
    const auto site = hand::find_grasp(path, spec.grasp_at);
    if (!site)
        diagnostics.error({file, 0}, "", kNoGrasp,
                          "Give the time when the fingers closed: movement: grasp_at_s.");
    return site;
}

void warn_of_faults(const hand::Path& path, const std::string& file, Diagnostics& diagnostics) {
    for (const hand::Fault& fault : path.faults) {
        if (!fault.wrong_unit) continue;
        diagnostics.warning(
            {file, fault.line}, path.fingers[static_cast<size_t>(fault.finger)],
            "this line's values are a thousandth of their neighbours': are they in metres instead "
            "of millimetres? They were bridged",
            "Multiply them by 1000.");
    }
    warn_of_bridges(path, file, diagnostics);
}

}  // namespace

void warn_of_bridges(const hand::Path& path, const std::string& file, Diagnostics& diagnostics) {
    if (path.bridged_share() <= hand::kMuchBridged) return;
    diagnostics.warning(
        {file, 0}, "",
        fmt::format("{:.0f} % of the movement is bridged: more guessed than measured",
                    100 * path.bridged_share()),
        "Record it again, or leave it out of the analysis.");
}

std::shared_ptr<const hand::Driver> place_movement(const task::MovementSpec& spec,
                                                   const std::string& file, const Place& asked_at,
                                                   scene::Scene& scene,
                                                   std::optional<MovementReport>& report,
                                                   Diagnostics& diagnostics) {
    hand::Movement movement =
        hand::read_movement(file, spec.axes, diagnostics, scene::finger_names(scene));
    if (!diagnostics.has_errors())
        hand::choose_fingers(movement, scene::finger_names(scene), diagnostics);
    scene::Body* block = find_box(scene, spec.block);
    if (block == nullptr) {
        diagnostics.error(asked_at, "movement.block",
                          fmt::format("the scene has no box named '{}'", spec.block),
                          "Name one of its boxes.");
    }
    if (scene.fingers.size() != 2) {
        diagnostics.error(asked_at, "movement",
                          fmt::format("the scene has {} fingers", scene.fingers.size()),
                          "A recorded grasp requires two.");
    }
    if (diagnostics.has_errors()) return nullptr;

    const hand::Path path = hand::repair(movement);
    const auto site = grasp_of(path, spec, file, asked_at, diagnostics);
    if (!site) return nullptr;
    // the block stays upright: it is turned only by the grasp direction in the horizontal plane
    const double yaw = std::atan2(site->axis.y(), site->axis.x());
    const Quat R_WB = rotation_xyz({0, 0, yaw});
    Faces faces = fit_faces(path, *site, R_WB, block->shape.size, scene, spec.squeeze);
    if (spec.width) {
        const double change = *spec.width - (faces.first + faces.second);
        faces.first += change / 2;
        faces.second += change / 2;
    }
    block->rotation = {0, 0, yaw};
    block->shape.size.x() = faces.first + faces.second;
    if (block->shape.size.x() < kThinnest) {
        diagnostics.error({file, 0}, "",
                          fmt::format("the fingers closed to {:.0f} mm, which leaves no space for "
                                      "a block between the proxies",
                                      site->aperture * 1e3),
                          "Make the proxies thinner, or give movement: width_mm.");
        return nullptr;
    }
    for (scene::Finger& finger : scene.fingers) finger.rotation.z() += yaw;
    const Vec3 block_centre = site->centre + R_WB * Vec3((faces.second - faces.first) / 2, 0, 0);

    report = MovementReport{file,         movement.checksum,    path.faults,
                            path.fingers, path.duration(),      path.bridged_share(),
                            *site,        block->shape.size.x()};
    warn_of_faults(path, file, diagnostics);
    return std::make_shared<hand::RecordedDriver>(path, *site, Vec3(block->position - block_centre),
                                                  scene::finger_names(scene));
}

}  // namespace dihaptic::session
