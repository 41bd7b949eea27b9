// Describes a texture: friction that rises and falls along a surface, as on a fine grating or grid.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "base/field_reader.h"

namespace dihaptic::scene {

/// Ridges across a direction, or bumps in rows and columns.
enum class TextureKind { grating, grid };
constexpr auto enum_names(TextureKind) {
    return std::array{"grating", "grid"};
}

struct Texture {
    TextureKind kind = TextureKind::grating;
    double wavelength = 0.002;   ///< from ridge to ridge [m]
    double friction = 0;         ///< share by which friction rises on ridges and falls between them
    Vec3 along = Vec3::UnitX();  ///< across the ridges of a grating, in the body's frame
    Place place;

    bool operator==(const Texture& other) const {
        return kind == other.kind && wavelength == other.wavelength && friction == other.friction &&
               along == other.along;
    }

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind, says("Ridges across a direction, or bumps in rows and columns."));
        v("wavelength", wavelength,
          Field::length().within(1e-4, 1).required().says("From one ridge to the next."));
        v("friction", friction,
          Field::number().within(0, 1).required().says(
              "Share by which the coefficient of friction rises on ridges and falls between "
              "them."));
        v("along", along,
          Field::number().within(-1e6, 1e6).says(
              "Direction across the ridges of a grating, in the body's frame, of any length."));
        if constexpr (requires { v.place(); }) place = v.place();
    }

    /// Factor on friction where a face with the normal n_B is touched at p_B [m]. A ridge goes
    /// through the body's origin; a grid has its rows along the two axes of the body's frame that
    /// the face looks along least.
    double factor(const Vec3& p_B, const Vec3& n_B) const noexcept {
        const auto wave = [&](double way) {
            return std::cos(2 * std::numbers::pi * way / wavelength);
        };
        if (kind == TextureKind::grating) return 1 + friction * wave(along.normalized().dot(p_B));
        int across = 0;
        n_B.cwiseAbs().maxCoeff(&across);
        const double bumps = (1 + wave(p_B[(across + 1) % 3])) * (1 + wave(p_B[(across + 2) % 3]));
        return 1 + friction * (bumps / 2 - 1);
    }
};

}  // namespace dihaptic::scene
