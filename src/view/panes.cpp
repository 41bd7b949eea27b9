#include "view/panes.h"

#include <Eigen/Dense>
#include <cmath>

namespace dihaptic::view {
namespace {

constexpr double kNearestShare =
    0.05;  // nearest visible distance, as a share of the distance of the screen

Viewpoint viewpoint(const display::Display& display, const Vec3& eye_W, double beyond) {
    Mat3 edges;
    edges << display.right(), display.up(), display.lower_left - eye_W;
    const Mat3 shares = edges.inverse();  // rows give alpha, beta, gamma
    // depth ranges from -1, at the nearest, to 1
    const Vec3 normal = display.right().cross(display.up()).normalized();
    const double furthest = 1 + beyond / std::abs(normal.dot(display.lower_left - eye_W));
    const double depth = (furthest + kNearestShare) / (furthest - kNearestShare);
    const double depth_0 = -2 * furthest * kNearestShare / (furthest - kNearestShare);
    const double x = display.mirrored == display::Mirrored::left_right ? -1 : 1;
    const double y = display.mirrored == display::Mirrored::up_down ? -1 : 1;
    Eigen::Matrix<double, 4, 3> clip;
    clip.row(0) = x * (2 * shares.row(0) - shares.row(2));
    clip.row(1) = y * (2 * shares.row(1) - shares.row(2));
    clip.row(2) = depth * shares.row(2);
    clip.row(3) = shares.row(2);
    Viewpoint out;
    out.eye_W = eye_W;
    out.clip_from_world.leftCols<3>() = clip;
    out.clip_from_world.col(3) = -clip * eye_W + Eigen::Vector4d(0, 0, depth_0, 0);
    out.flipped = display.mirrored != display::Mirrored::no;
    return out;
}

}  // namespace

std::vector<Pane> panes(const display::Display& display, double beyond) {
    if (display.stereo == display::Stereo::none || display.stereo == display::Stereo::in_turn)
        return {{viewpoint(display, display.eyes.position, beyond)}};
    Pane left{viewpoint(display, display.eyes.left(), beyond)};
    Pane right{viewpoint(display, display.eyes.right(), beyond)};
    switch (display.stereo) {
        case display::Stereo::none:
        case display::Stereo::in_turn:
            break;
        case display::Stereo::side_by_side:
            left.width = right.width = right.left = 0.5;
            break;
        case display::Stereo::top_bottom:
            left.height = right.height = left.bottom = 0.5;
            break;
        case display::Stereo::anaglyph:
            left.green_blue = right.red = false;
            break;
    }
    return {left, right};
}

Viewpoint viewpoint(const Pose& X_WE, const FieldOfView& sees, double nearest, double furthest) {
    const double left = std::tan(sees.left), right = std::tan(sees.right);
    const double up = std::tan(sees.up), down = std::tan(sees.down);
    Eigen::Matrix4d clip_from_eye;
    clip_from_eye << 2 / (right - left), 0, (right + left) / (right - left), 0,  //
        0, 2 / (up - down), (up + down) / (up - down), 0,                        //
        0, 0, -(furthest + nearest) / (furthest - nearest),
        -2 * furthest * nearest / (furthest - nearest),  //
        0, 0, -1, 0;
    const Pose X_EW = X_WE.inverse();
    Eigen::Matrix4d eye_from_world = Eigen::Matrix4d::Identity();
    eye_from_world.topLeftCorner<3, 3>() = X_EW.R.toRotationMatrix();
    eye_from_world.topRightCorner<3, 1>() = X_EW.p;
    return {X_WE.p, clip_from_eye * eye_from_world};
}

}  // namespace dihaptic::view
