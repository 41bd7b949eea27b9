// Describes the position of a screen as seen directly or in a mirror, and the person's eyes, so
// that objects can be drawn where the hand feels them.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "base/diagnostics.h"
#include "base/field.h"
#include "base/geometry.h"
#include "display/registration.h"

namespace dihaptic::display {

/// How a mirror flips the picture of the screen. The picture is drawn flipped to compensate.
enum class Mirrored { no, left_right, up_down };
constexpr auto enum_names(Mirrored) {
    return std::array{"no", "left_right", "up_down"};
}

/// How the pictures for the two eyes share the screen.
enum class Stereo { none, side_by_side, top_bottom, anaglyph, in_turn };
constexpr auto enum_names(Stereo) {
    return std::array{"none", "side_by_side", "top_bottom", "anaglyph", "in_turn"};
}

enum class Corner { lower_left, lower_right, upper_left, upper_right };
constexpr auto enum_names(Corner) {
    return std::array{"lower_left", "lower_right", "upper_left", "upper_right"};
}

/// A square in a corner of the picture, for a photodiode: white while a state of the task requests
/// it, otherwise black.
struct Patch {
    Corner corner = Corner::lower_right;  ///< corner of the monitor's picture
    double size = 0.08;                   ///< side length, as a fraction of the picture's height

    template <class Visitor>
    void visit(Visitor& v) {
        v("corner", corner, says("Corner of the monitor's picture in which the square is drawn."));
        v("size", size,
          Field::number().within(0.01, 0.5).says(
              "Edge of the square, as a fraction of the picture's height."));
    }
};

/// The eyes of a head that is either at rest or tracked.
struct Eyes {
    Vec3 position = Vec3::Zero();  ///< midpoint between the eyes [m]
    Vec3 along = Vec3::UnitX();    ///< direction from the left eye to the right eye, of any length
    double distance = 0.063;       ///< distance between the pupils [m]
    bool tracked = false;          ///< whether the eyes move with Rig::head
    Place place{};

    Vec3 left() const { return position - distance / 2 * along.normalized(); }
    Vec3 right() const { return position + distance / 2 * along.normalized(); }
    Vec3 of(bool right_one) const { return right_one ? right() : left(); }

    template <class Visitor>
    void visit(Visitor& v) {
        v("position", position,
          Field::length().within(-100, 100).required().says(
              "Position of the midpoint between the eyes."));
        v("along", along,
          Field::number().within(-1e6, 1e6).says(
              "Direction from the left to the right eye, of any length."));
        v("distance", distance,
          Field::length().within(0.03, 0.1).says(
              "Distance between the pupils; 50 to 75 mm in adults."));
        v("tracked", tracked,
          says("Whether the eyes move with the tracked head; 'position' and 'along' then apply "
               "until "
               "the tracker sees the head."));
    }
};

/// A screen as the person sees it; for a mirror, the mirror image of the screen. Corners are named
/// as the person sees them: lower_left is at the person's lower left.
struct Display {
    std::string name;
    Vec3 lower_left = Vec3::Zero();  ///< [m]
    Vec3 lower_right = Vec3::Zero();
    Vec3 upper_left = Vec3::Zero();
    Mirrored mirrored = Mirrored::no;
    Eyes eyes;
    Stereo stereo = Stereo::none;
    std::string registration;  ///< path of the registration file, relative to the folder of the rig
                               ///< file; empty if there is none
    std::optional<Registration> registered;  ///< contents of that file, in world coordinates
    std::string monitor;  ///< name of the screen in the system; empty: any screen that does not
                          ///< show the operator's window
    Place place{};

    Vec3 right() const { return lower_right - lower_left; }
    Vec3 up() const { return upper_left - lower_left; }
    /// Position on the screen at which the person sees a cross [m].
    Vec3 at(const Cross& cross) const {
        return lower_left + cross.right * right() + cross.up * up();
    }
    /// Distance of an eye from the screen's plane [m]; negative if the eye is behind the plane.
    double before(const Vec3& eye) const;
    /// Whether these eyes are in front of the screen, and far enough from it for drawing.
    bool faces(const Eyes& seen_by) const;
    void move(const Vec3& by);
    /// Adopts the corners found in a registration.
    void set(const Registration& found);

    template <class Visitor>
    void visit(Visitor& v) {
        const Field corner = Field::length().within(-100, 100).required();
        v("name", name, Field::text().required().says("Name of the display."));
        v("lower_left", lower_left,
          corner.says("Lower left corner of the picture, as the person sees it."));
        v("lower_right", lower_right, corner.says("Lower right corner of the picture."));
        v("upper_left", upper_left, corner.says("Upper left corner of the picture."));
        v("mirrored", mirrored, says("How a mirror reverses the picture."));
        v("eyes", eyes, Field::text().required().says("The person's eyes."));
        v("stereo", stereo, says("How the pictures for the two eyes share the screen."));
        v("registration", registration,
          Field::text().says(
              "Registration file, relative to this file. It gives the screen's position as "
              "measured with a finger, and is used in place of the corners."));
        v("monitor", monitor,
          Field::text().says("Name of the monitor, as listed in the window's log; if left out, "
                             "a monitor without the operator's window."));
    }
};

/// Checks that the display is a rectangle and that the eyes are in front of it.
void check(const Display& display, Diagnostics& diagnostics);

}  // namespace dihaptic::display
