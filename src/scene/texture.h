// Describes a texture: friction and height that rise and fall along a surface, as on a fine
// grating, a grid, or as a picture says.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "base/field_reader.h"

namespace dihaptic::scene {

class ReliefPicture;

/// Ridges across a direction, bumps in rows and columns, or a picture from a file.
enum class TextureKind { grating, grid, picture };
constexpr auto enum_names(TextureKind) {
    return std::array{"grating", "grid", "picture"};
}

/// The state of a texture at a point of contact.
struct Relief {
    double friction = 1;        ///< factor on the coefficient
    double height = 0;          ///< above the face [m]
    Vec3 slope = Vec3::Zero();  ///< of the height along the face: by how much it rises a metre
};

struct Texture {
    /// Contacts are found this far ahead, and no steeper face can be slid over.
    static constexpr double kHighest = 3e-4;  // [m]
    static constexpr double kSteepest = 1;

    TextureKind kind = TextureKind::grating;
    double wavelength = 0.002;   ///< from ridge to ridge, or width of the picture [m]
    double friction = 0;         ///< share by which friction rises on ridges and falls between them
    double height = 0;           ///< of ridges above what is between them [m]
    Vec3 along = Vec3::UnitX();  ///< across ridges, or to a picture's right, in the body's frame
    std::string file;            ///< of a picture
    std::shared_ptr<const ReliefPicture> picture;  ///< what the file holds
    Place place;

    bool operator==(const Texture& other) const {
        return kind == other.kind && wavelength == other.wavelength && friction == other.friction &&
               height == other.height && along == other.along && file == other.file;
    }

    template <class Visitor>
    void visit(Visitor& v) {
        v("kind", kind,
          says("Ridges across a direction, bumps in rows and columns, or what a file draws."));
        v("wavelength", wavelength,
          Field::length().within(1e-4, 1).required().says(
              "From one ridge to the next; of a picture, its width, after which it repeats."));
        v("friction", friction,
          Field::number().within(0, 1).says(
              "Share by which the coefficient of friction rises on ridges and falls between "
              "them."));
        v("height", height,
          Field::length().within(0, kHighest).says("Of ridges above what is between them."));
        v("along", along,
          Field::number().within(-1e6, 1e6).says(
              "Direction across the ridges of a grating, or to a picture's right, in the body's "
              "frame, of any length."));
        v("file", file,
          Field::text().says("PNG file of a picture, relative to this one: white is a ridge."));
        if constexpr (requires { v.place(); }) place = v.place();
    }

    /// Its steepest slope.
    double steepest() const noexcept;

    /// Where a face with the normal n_B is touched at p_B [m], in the body's frame. A ridge goes
    /// through the body's origin; a grid has its rows along the two axes of the body's frame that
    /// the face looks along least; a picture has its middle at the origin. With r from 0 between
    /// ridges to 1 on them, the factor on friction is 1 + friction (2 r - 1), and the height is
    /// height r.
    Relief at(const Vec3& p_B, const Vec3& n_B) const noexcept;

  private:
    /// Width of a pixel [m]. Needs the picture.
    double pixel() const noexcept;
};

}  // namespace dihaptic::scene
