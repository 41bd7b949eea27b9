// Describes a texture: friction and height that rise and fall along a surface, as on a fine grating
// or grid.
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

/// How a texture is where it is touched.
struct Relief {
    double friction = 1;        ///< factor on the coefficient
    double height = 0;          ///< above the face [m]
    Vec3 slope = Vec3::Zero();  ///< of the height along the face: by how much it rises a metre
};

struct Texture {
    /// Contacts are known this far ahead, and no steeper face can be slid over.
    static constexpr double kHighest = 3e-4;  // [m]
    static constexpr double kSteepest = 1;

    TextureKind kind = TextureKind::grating;
    double wavelength = 0.002;   ///< from ridge to ridge [m]
    double friction = 0;         ///< share by which friction rises on ridges and falls between them
    double height = 0;           ///< of ridges above what is between them [m]
    Vec3 along = Vec3::UnitX();  ///< across the ridges of a grating, in the body's frame
    Place place;

    bool operator==(const Texture& other) const {
        return kind == other.kind && wavelength == other.wavelength && friction == other.friction &&
               height == other.height && along == other.along;
    }

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind, says("Ridges across a direction, or bumps in rows and columns."));
        v("wavelength", wavelength,
          Field::length().within(1e-4, 1).required().says("From one ridge to the next."));
        v("friction", friction,
          Field::number().within(0, 1).says(
              "Share by which the coefficient of friction rises on ridges and falls between "
              "them."));
        v("height", height,
          Field::length().within(0, kHighest).says("Of ridges above what is between them."));
        v("along", along,
          Field::number().within(-1e6, 1e6).says(
              "Direction across the ridges of a grating, in the body's frame, of any length."));
        if constexpr (requires { v.place(); }) place = v.place();
    }

    /// The steepest slope that it has anywhere.
    double steepest() const noexcept { return std::numbers::pi * height / wavelength; }

    /// Where a face with the normal n_B is touched at p_B [m], in the body's frame. A ridge goes
    /// through the body's origin; a grid has its rows along the two axes of the body's frame that
    /// the face looks along least. With r from 0 between ridges to 1 on them, the factor on
    /// friction is 1 + friction (2 r - 1), and the height is height r.
    Relief at(const Vec3& p_B, const Vec3& n_B) const noexcept {
        const double k = 2 * std::numbers::pi / wavelength;
        double r = 0;
        Vec3 rise = Vec3::Zero();  // of r
        if (kind == TextureKind::grating) {
            const Vec3 across = along.normalized();
            const double phase = k * across.dot(p_B);
            r = (1 + std::cos(phase)) / 2;
            rise = -k / 2 * std::sin(phase) * across;
        } else {
            int out = 0;
            n_B.cwiseAbs().maxCoeff(&out);
            const int i = (out + 1) % 3, j = (out + 2) % 3;
            const double x = 1 + std::cos(k * p_B[i]), y = 1 + std::cos(k * p_B[j]);
            r = x * y / 4;
            rise[i] = -k / 4 * std::sin(k * p_B[i]) * y;
            rise[j] = -k / 4 * std::sin(k * p_B[j]) * x;
        }
        return {1 + friction * (2 * r - 1), height * r, height * (rise - n_B.dot(rise) * n_B)};
    }
};

}  // namespace dihaptic::scene
