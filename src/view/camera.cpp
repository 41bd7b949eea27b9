#include "view/camera.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace dihaptic::view {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNearest = 0.01;  // [m]
constexpr double kFurthest = 100;  // [m]

struct Orbit {
    double distance, azimuth, elevation;
};

Orbit orbit_of(const Camera& camera) {
    const Vec3 d = camera.position - camera.look_at;
    const double across = std::hypot(d.x(), d.y());
    const double distance = std::hypot(across, d.z());
    // straight above, where there is no direction, use the azimuth of the person's side
    const double azimuth = across > 1e-9 * distance ? std::atan2(d.x(), -d.y()) : 0;
    return {distance, azimuth, std::atan2(d.z(), across)};
}

Camera with(const Camera& camera, const Orbit& o) {
    Camera out = camera;
    out.position = camera.look_at + o.distance * Vec3(std::sin(o.azimuth) * std::cos(o.elevation),
                                                      -std::cos(o.azimuth) * std::cos(o.elevation),
                                                      std::sin(o.elevation));
    return out;
}

/// A point slightly above the middle of the movable bodies, because bodies will be lifted.
Vec3 middle(const scene::Scene& scene) {
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (const scene::Body& body : scene.bodies) {
        if (!body.moves_at_all()) continue;
        sum += body.position;
        ++count;
    }
    return (count > 0 ? Vec3(sum / count) : Vec3::Zero()) + Vec3(0, 0, 0.03);
}

/// Radius of a ball about `centre` that encloses the movable bodies and the hands around them [m].
double reach(const scene::Scene& scene, const Vec3& centre) {
    double out = 0.12;
    for (const scene::Body& body : scene.bodies) {
        if (!body.moves_at_all()) continue;
        out = std::max(out, (body.position - centre).norm() + scene::extent(body.shape) / 2 + 0.02);
    }
    return out;
}

}  // namespace

std::vector<Camera> cameras(const scene::Scene& scene) {
    std::vector<Camera> out = scene.cameras;
    const auto is_new = [&](const std::string& name) {
        return std::none_of(out.begin(), out.end(),
                            [&](const Camera& camera) { return camera.name == name; });
    };
    Camera camera;
    camera.look_at = middle(scene);
    const double fit = reach(scene, camera.look_at) / std::sin(camera.field_of_view / 2);
    const auto add = [&](const char* name, double azimuth, double elevation) {
        if (!is_new(name)) return;
        camera.name = name;
        out.push_back(with(camera, {fit, azimuth * kPi / 180, elevation * kPi / 180}));
    };
    add("front", 0, 30);
    add("above", 0, 90);
    add("side", 90, 12);
    return out;
}

Camera find_camera(const std::vector<Camera>& cameras, const std::string& name) {
    std::vector<std::string> names;
    for (const Camera& camera : cameras) {
        if (camera.name == name) return camera;
        names.push_back(camera.name);
    }
    throw Error(fmt::format("there is no camera '{}'", name),
                fmt::format("Available cameras: {}; a scene may define more, under 'cameras'.",
                            fmt::join(names, ", ")));
}

Camera orbited(const Camera& camera, double azimuth, double elevation) {
    Orbit o = orbit_of(camera);
    o.azimuth = std::remainder(o.azimuth + azimuth, 2 * kPi);
    // stay slightly away from the vertical, where the position does not define the azimuth
    constexpr double kSteepest = kPi / 2 - 1e-6;
    o.elevation = std::clamp(o.elevation + elevation, -kSteepest, kSteepest);
    return with(camera, o);
}

Camera panned(const Camera& camera, double right, double up) {
    const Pose X_WV = view_pose(camera);
    const double height =
        2 * std::tan(camera.field_of_view / 2) * (camera.position - camera.look_at).norm();
    const Vec3 by = X_WV.R * Vec3(-right * height, -up * height, 0);
    Camera out = camera;
    out.position += by;
    out.look_at += by;
    return out;
}

Camera zoomed(const Camera& camera, double factor) {
    Orbit o = orbit_of(camera);
    o.distance = std::clamp(o.distance * factor, kNearest, kFurthest);
    return with(camera, o);
}

double azimuth(const Camera& camera) {
    return orbit_of(camera).azimuth;
}

Pose view_pose(const Camera& camera) {
    const Orbit o = orbit_of(camera);
    Mat3 R_WV;
    R_WV.col(0) = Vec3(std::cos(o.azimuth), std::sin(o.azimuth), 0);
    R_WV.col(1) = Vec3(-std::sin(o.azimuth) * std::sin(o.elevation),
                       std::cos(o.azimuth) * std::sin(o.elevation), std::cos(o.elevation));
    R_WV.col(2) = R_WV.col(0).cross(R_WV.col(1));
    return {Quat(R_WV), camera.position};
}

Eigen::Matrix4d projection(const Camera& camera, double aspect, double near, double far) {
    const double f = 1 / std::tan(camera.field_of_view / 2);
    Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
    clip(0, 0) = f / aspect;
    clip(1, 1) = f;
    clip(2, 2) = (far + near) / (near - far);
    clip(2, 3) = 2 * far * near / (near - far);
    clip(3, 2) = -1;
    const Pose X_VW = view_pose(camera).inverse();
    Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
    view.topLeftCorner<3, 3>() = X_VW.R.toRotationMatrix();
    view.topRightCorner<3, 1>() = X_VW.p;
    return clip * view;
}

}  // namespace dihaptic::view
