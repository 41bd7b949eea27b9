// A regular friction polygon: n directions in the contact's tangent plane, the first of them at
// `angle`. Its vertices lie on the circle of radius mu N, so friction is mu N along a direction and
// mu N cos(pi / n) between two.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace dihaptic::contact {

struct Polygon {
    int directions = 8;
    double angle = 0;  ///< of direction 0 from the first tangent [rad]

    double direction_angle(int i) const noexcept {
        return angle + 2 * std::numbers::pi * i / directions;
    }
    Eigen::Vector2d direction(int i) const noexcept {
        const double phi = direction_angle(i);
        return {std::cos(phi), std::sin(phi)};
    }
    /// The direction before a vector: it lies between this one and the next.
    int before(const Eigen::Vector2d& x) const noexcept {
        const double pitch = 2 * std::numbers::pi / directions;
        double turns = (std::atan2(x[1], x[0]) - angle) / pitch;
        turns -= std::floor(turns / directions) * directions;
        // also of what is no number there is one, whose index exists
        return turns >= 0 && turns < directions ? static_cast<int>(turns) : 0;
    }

    struct Projection {
        Eigen::Vector2d point;
        bool inside = false;
        Eigen::Vector2d edge;        ///< unit vector along the edge hit; zero at a vertex
        Eigen::Vector2d per_radius;  ///< d point / d radius
    };
    /// Nearest point of the polygon with vertices at `radius`.
    Projection project(const Eigen::Vector2d& x, double radius) const noexcept {
        Projection out;
        out.edge.setZero();
        out.per_radius.setZero();
        if (radius <= 0) {
            out.point.setZero();
            return out;
        }
        const int i = before(x);
        const Eigen::Vector2d from = direction(i);
        const Eigen::Vector2d to = direction(i + 1);
        const Eigen::Vector2d normal = (from + to).normalized();
        const double apothem = normal.dot(from);  // of the unit polygon
        const Eigen::Vector2d edge(-normal[1], normal[0]);
        if (normal.dot(x) <= radius * apothem) {
            out.point = x;
            out.inside = true;
            return out;
        }
        const double along = edge.dot(x);
        const double half = radius * edge.dot(to);
        if (along >= half) {
            out.per_radius = to;
        } else if (along <= -half) {
            out.per_radius = from;
        } else {
            out.edge = edge;
            out.per_radius = apothem * normal;
        }
        out.point = radius * out.per_radius + out.edge * along;
        return out;
    }
};

}  // namespace dihaptic::contact
