// Draws points of the world as small black balls, and locates them in a picture.
#pragma once

#include <cmath>
#include <string>

#include "base/image.h"
#include "base/number.h"
#include "frame/frame.h"
#include "scene/scene.h"

namespace dihaptic::view {

struct Balls {
    scene::Scene scene;
    frame::Frame frame;

    /// Adds a ball with this radius at a point [m].
    void add(const Vec3& p_W, double radius = 0.0025) {
        scene::Body ball;
        ball.name = "ball " + number_text(scene.bodies.size());
        ball.shape = scene::Shape::sphere(radius);
        ball.mass = 0.01;
        ball.position = p_W;
        ball.colour = "#000000";
        scene.bodies.push_back(ball);
        frame.bodies.push_back({ball.pose()});
    }
    /// The frame with all balls moved out of view.
    frame::Frame away() const {
        frame::Frame out = frame;
        for (frame::BodyFrame& body : out.bodies) body.X_WB.p = {0, 0, -50};
        return out;
    }
};

/// The middle of the pixels that differ between a picture and the empty picture, within 12 pixels
/// of the point `around` and in one colour channel [pixels from the upper left]. Far off if no
/// pixels differ.
inline Eigen::Vector2d middle_of(const Image& picture, const Image& empty, int channel,
                                 const Eigen::Vector2d& around) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    int count = 0;
    for (int y = static_cast<int>(around.y()) - 12; y <= around.y() + 12; ++y) {
        for (int x = static_cast<int>(around.x()) - 12; x <= around.x() + 12; ++x) {
            const Eigen::Vector2d here(x + 0.5, y + 0.5);
            if ((here - around).norm() > 12) continue;
            if (std::abs(picture.at(x, y)[channel] - empty.at(x, y)[channel]) < 40) continue;
            sum += here;
            ++count;
        }
    }
    return count > 0 ? Eigen::Vector2d(sum / count) : Eigen::Vector2d::Constant(-1e6);
}

}  // namespace dihaptic::view
