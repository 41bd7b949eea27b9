// A friction polygon: n evenly spaced directions in the contact's tangent plane, the first of them
// along axes.col(0). Its vertices lie on the circle of radius mu N, so friction is mu N along a
// direction and mu N cos(pi / n) halfway between two directions. With torsion (T = 3), the shape is
// a double pyramid: the polygon and two further vertices, one on either side along axes.col(2).
//
// A regular polygon, and such a pyramid, are symmetric about the planes between neighbouring
// directions. So, for a vector in the sector between two directions, the nearest point lies in that
// sector too, on the one facet that spans the sector's T vertices.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace dihaptic::contact {

template <int T>
struct Polygon {
    static_assert(T == 2 || T == 3);
    using Tangent = Eigen::Matrix<double, T, 1>;
    using Square = Eigen::Matrix<double, T, T>;

    int directions = 8;
    Square axes = Square::Identity();  ///< orthonormal

    /// Aligns the first direction with a vector. Does nothing if the vector has no direction.
    void turn_to(const Tangent& first) noexcept {
        const double length = first.norm();
        if (!(length > 0) || !std::isfinite(length)) return;
        axes.col(0) = first / length;
        if constexpr (T == 2) {
            axes.col(1) = Tangent(-axes(1, 0), axes(0, 0));
        } else {
            // perpendicular to the first axis, in the tangent plane if possible
            const Tangent across(-axes(1, 0), axes(0, 0), 0);
            const double size = across.norm();
            axes.col(1) = size > 1e-6 ? Tangent(across / size) : Tangent::UnitX();
            axes.col(2) = axes.col(0).cross(axes.col(1));
        }
    }

    int count() const noexcept { return T == 2 ? directions : directions + 2; }
    /// Direction i of the polygon. With torsion, the last two are the tips of the double pyramid.
    Tangent direction(int i) const noexcept {
        if constexpr (T == 3) {
            if (i == directions) return axes.col(2);
            if (i == directions + 1) return -axes.col(2);
        }
        const double phi = 2 * std::numbers::pi * i / directions;
        return std::cos(phi) * axes.col(0) + std::sin(phi) * axes.col(1);
    }

    /// The sector that contains a vector.
    struct Sector {
        std::array<int, T> index;  ///< indices of the sector's directions
        Square vertices;           ///< the directions, one per column
        Square inverse;            ///< inverse of `vertices`: maps a vector to its coefficients
    };
    Sector sector(const Tangent& x) const noexcept {
        const double pitch = 2 * std::numbers::pi / directions;
        double turns = std::atan2(axes.col(1).dot(x), axes.col(0).dot(x)) / pitch;
        turns -= std::floor(turns / directions) * directions;
        // even a vector that is not a number gets a sector with valid indices
        const int before = turns >= 0 && turns < directions ? static_cast<int>(turns) : 0;
        Sector out;
        out.index[0] = before;
        out.index[1] = (before + 1) % directions;
        if constexpr (T == 3) out.index[2] = axes.col(2).dot(x) >= 0 ? directions : directions + 1;
        for (int i = 0; i < T; ++i)
            out.vertices.col(i) = direction(out.index[static_cast<size_t>(i)]);
        out.inverse = out.vertices.inverse();
        return out;
    }

    /// The maximum of d_k . x over all directions d_k.
    double support(const Tangent& x) const noexcept {
        const Sector in = sector(x);
        return (in.vertices.transpose() * x).maxCoeff();
    }

    struct Projection {
        Tangent point;
        bool inside = false;
        Square along;        ///< projector onto the nearest facet or edge; zero at a vertex
        Tangent per_radius;  ///< derivative of the nearest point with respect to the radius
    };
    /// Returns the point nearest to x of the polygon whose vertices are at `radius`.
    Projection project(const Tangent& x, double radius) const noexcept {
        Projection out;
        out.along.setZero();
        out.per_radius.setZero();
        out.point.setZero();
        if (radius <= 0) return out;
        const Sector in = sector(x);
        // the facet lies in the plane normal . x = radius
        const Tangent normal = in.inverse.transpose() * Tangent::Ones();
        const double beyond = normal.dot(x) - radius;
        if (beyond <= 0) {
            out.point = x;
            out.inside = true;
            return out;
        }
        const double square = normal.squaredNorm();
        const Tangent on_plane = x - beyond / square * normal;
        if ((in.inverse * on_plane).minCoeff() >= 0) {
            out.point = on_plane;
            out.along = Square::Identity() - normal * normal.transpose() / square;
            out.per_radius = normal / square;
            return out;
        }
        double nearest = std::numeric_limits<double>::infinity();
        const auto offer = [&](const Tangent& per_radius, const Square& along) {
            const Tangent point = radius * per_radius + along * x;
            const double distance = (point - x).squaredNorm();
            if (distance >= nearest) return;
            nearest = distance;
            out.point = point;
            out.along = along;
            out.per_radius = per_radius;
        };
        for (int i = 0; i < T; ++i) offer(in.vertices.col(i), Square::Zero());
        if constexpr (T == 3) {
            for (int i = 0; i < T; ++i) {
                const Tangent from = in.vertices.col(i);
                const Tangent edge = in.vertices.col((i + 1) % T) - from;
                const double share = edge.dot(x / radius - from) / edge.squaredNorm();
                if (share <= 0 || share >= 1) continue;
                const Square along = edge * edge.transpose() / edge.squaredNorm();
                offer(from - along * from, along);
            }
        }
        return out;
    }
};

}  // namespace dihaptic::contact
