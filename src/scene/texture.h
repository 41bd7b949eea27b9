// Describes a texture: a variation of friction and height along a surface, in the form of a fine
// grating or a grid, or as given by a picture.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "base/field_reader.h"

namespace dihaptic::scene {

class ReliefPicture;

/// The kinds of textures: parallel ridges, bumps in rows and columns, or a picture from a file.
enum class TextureKind { grating, grid, picture };
constexpr auto enum_names(TextureKind) {
    return std::array{"grating", "grid", "picture"};
}

/// The state of a texture at a point of contact.
struct Relief {
    double friction = 1;        ///< factor by which the coefficient of friction is multiplied
    double height = 0;          ///< height above the face [m]
    Vec3 slope = Vec3::Zero();  ///< gradient of the height along the face
};

struct Texture {
    /// Limits for textures: contacts are detected kHighest ahead, and a finger cannot slide over a
    /// steeper face.
    static constexpr double kHighest = 3e-4;  // [m]
    static constexpr double kSteepest = 1;

    TextureKind kind = TextureKind::grating;
    double wavelength = 0.002;  ///< distance from ridge to ridge, or width of the picture [m]
    double friction = 0;  ///< fraction by which friction rises on ridges and falls between them
    double height = 0;    ///< height of ridges above the valleys [m]
    Vec3 along =
        Vec3::UnitX();  ///< across the ridges, or toward a picture's right, in the body's frame
    std::string file;   ///< file that contains the picture
    std::shared_ptr<const ReliefPicture> picture;  ///< the content of the file
    Place place;

    bool operator==(const Texture& other) const {
        return kind == other.kind && wavelength == other.wavelength && friction == other.friction &&
               height == other.height && along == other.along && file == other.file;
    }

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind,
          says("Ridges across a direction, bumps in rows and columns, or a picture from a file."));
        v("wavelength", wavelength,
          Field::length().within(1e-4, 1).required().says(
              "Distance between ridges; for a picture, its width, after which it repeats."));
        v("friction", friction,
          Field::number().within(0, 1).says(
              "Fraction by which the coefficient of friction rises on ridges and falls between "
              "them."));
        v("height", height,
          Field::length().within(0, kHighest).says("Height of ridges above the valleys."));
        v("along", along,
          Field::number().within(-1e6, 1e6).says("Direction across the ridges of a grating, or "
                                                 "toward a picture's right, in the body's "
                                                 "frame, of any length."));
        v("file", file,
          Field::text().says("PNG file of the picture, relative to this file; white is high."));
    }

    /// The steepest slope of the texture.
    double steepest() const noexcept;

    /// Takes the wavelength, height and friction of `given`, multiplied by the given factors, but
    /// limited to kHighest, kSteepest and a friction of 1. Does not allocate.
    void scale(const Texture& given, double wavelength_scale, double height_scale,
               double friction_scale) noexcept;

    /// The texture at p_B [m] on a face with the normal n_B, both in the body's frame. For a
    /// grating, a ridge passes through the body's origin; a grid has its rows along the two axes of
    /// the body's frame that are most nearly parallel to the face; a picture is centred on the
    /// origin. Where r rises from 0 between ridges to 1 on them, the factor on friction is 1 +
    /// friction (2 r - 1), and the height is height r.
    Relief at(const Vec3& p_B, const Vec3& n_B) const noexcept;

  private:
    /// Width of a pixel [m]. Requires a picture.
    double pixel() const noexcept;
};

}  // namespace dihaptic::scene
