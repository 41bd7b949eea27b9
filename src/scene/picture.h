// Describes a picture that covers a body in place of a colour.
#pragma once

#include <memory>
#include <string>

#include "base/diagnostics.h"
#include "base/field.h"
#include "base/image.h"
#include "scene/shape.h"

namespace dihaptic::scene {

/// An image of known size that is repeated over a body. It is projected along one of the axes of
/// the body's frame, at each point along the axis closest to the surface normal. The middle of the
/// image is at the body's origin. Its upward direction is z; on surfaces that face along z, it is y
/// if seen from above, and -y if seen from below.
struct Picture {
    static constexpr int kMostPixels = 4096;  ///< limit along an edge

    std::string file;                    ///< a PNG file, relative to the scene file
    double width = 0;                    ///< repeat distance; the height follows from it [m]
    std::shared_ptr<const Image> image;  ///< shared by all bodies that name the same file
    Place place;                         ///< where the scene file gives the picture

    template <class Visitor>
    void visit(Visitor& v) {
        v("file", file, Field::text().required().says("PNG file, relative to this one."));
        v("width", width,
          Field::length()
              .within(kSmallest, kLargest)
              .required()
              .says("Width of the picture, after which it repeats."));
        if constexpr (requires { v.place(); }) place = v.place_of("file");
    }
};

/// Reads a PNG file with edges of `fewest` to `most` pixels. Throws Error, at that place and for
/// the key `file`, if the file is not a PNG file or has another size.
Image read_picture(const std::string& file, int fewest, int most, const Place& place);
/// Like read_picture(), for a picture whose grey levels are data.
GreyImage read_data(const std::string& file, int fewest, int most, const Place& place);

}  // namespace dihaptic::scene
