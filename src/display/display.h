// Describes where the person sees a screen, directly or in a mirror, and with which eyes, so that
// things are drawn where the hand feels them.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "base/diagnostics.h"
#include "base/field.h"
#include "base/geometry.h"
#include "display/registration.h"

namespace dihaptic::display {

/// How a mirror flips the screen's picture, which is drawn flipped to make up for it.
enum class Mirrored { no, left_right, up_down };
constexpr auto enum_names(Mirrored) {
    return std::array{"no", "left_right", "up_down"};
}

/// How the pictures for two eyes share the screen.
enum class Stereo { none, side_by_side, top_bottom, anaglyph, in_turn };
constexpr auto enum_names(Stereo) {
    return std::array{"none", "side_by_side", "top_bottom", "anaglyph", "in_turn"};
}

enum class Corner { lower_left, lower_right, upper_left, upper_right };
constexpr auto enum_names(Corner) {
    return std::array{"lower_left", "lower_right", "upper_left", "upper_right"};
}

/// A square for a photodiode in a corner of what the person sees: white while a state of the task
/// asks for it, otherwise black.
struct Patch {
    Corner corner = Corner::lower_right;  ///< of the monitor's picture
    double size = 0.08;                   ///< share of the picture's height

    template <class Visitor>
    void visit(Visitor& v) {
        v("corner", corner, says("Corner of the monitor's picture that it is in."));
        v("size", size,
          Field::number().within(0.01, 0.5).says("Its edge, as a share of the picture's height."));
    }
};

/// Eyes of a head that rests, or that is tracked.
struct Eyes {
    Vec3 position = Vec3::Zero();  ///< of the middle between them [m]
    Vec3 along = Vec3::UnitX();    ///< from the left one to the right one, of any length
    double distance = 0.063;       ///< of their pupils [m]
    bool tracked = false;          ///< they move with Rig::head
    Place place{};

    Vec3 left() const { return position - distance / 2 * along.normalized(); }
    Vec3 right() const { return position + distance / 2 * along.normalized(); }
    Vec3 of(bool right_one) const { return right_one ? right() : left(); }

    template <class Visitor>
    void visit(Visitor& v) {
        v("position", position,
          Field::length().within(-100, 100).required().says("Of the middle between both eyes."));
        v("along", along,
          Field::number().within(-1e6, 1e6).says(
              "Direction from the left eye to the right one, of any length."));
        v("distance", distance,
          Field::length().within(0.03, 0.1).says("Between the pupils; adults have 50 to 75 mm."));
        v("tracked", tracked,
          says("Whether they move with the rig's head; position and along then count until the "
               "tracker sees it."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// A screen as it is seen: in a mirror, at the place of its image. Its corners are named as the
/// person sees them, so the lower left one is at the person's lower left.
struct Display {
    std::string name;
    Vec3 lower_left = Vec3::Zero();  ///< [m]
    Vec3 lower_right = Vec3::Zero();
    Vec3 upper_left = Vec3::Zero();
    Mirrored mirrored = Mirrored::no;
    Eyes eyes;
    Stereo stereo = Stereo::none;
    std::string registration;  ///< path of its file, from the rig file's folder; empty: none
    std::optional<Registration> registered;  ///< what it holds, in the world
    std::string monitor;  ///< its name in the system; empty: one that the operator does not look at
    Place place{};

    Vec3 right() const { return lower_right - lower_left; }
    Vec3 up() const { return upper_left - lower_left; }
    /// Where the person sees a cross on it [m].
    Vec3 at(const Cross& cross) const {
        return lower_left + cross.right * right() + cross.up * up();
    }
    /// Distance of an eye from the screen's plane [m]; negative behind it.
    double before(const Vec3& eye) const;
    /// Whether these eyes see it from the front, and from far enough to be drawn.
    bool faces(const Eyes& seen_by) const;
    void move(const Vec3& by);
    /// Takes the corners of a registration.
    void set(const Registration& found);

    template <class Visitor>
    void visit(Visitor& v) {
        const Field corner = Field::length().within(-100, 100).required();
        v("name", name, Field::text().required().says("Name of the display."));
        v("lower_left", lower_left,
          corner.says("Where the person sees the picture's lower left corner."));
        v("lower_right", lower_right, corner.says("Its lower right corner."));
        v("upper_left", upper_left, corner.says("Its upper left corner."));
        v("mirrored", mirrored, says("How a mirror turns the picture round."));
        v("eyes", eyes, Field::text().required().says("Where the person's eyes are."));
        v("stereo", stereo, says("How the pictures for both eyes share the screen."));
        v("registration", registration,
          Field::text().says(
              "File of its registration, relative to this file: where a finger found "
              "the screen, which counts in place of the corners."));
        v("monitor", monitor,
          Field::text().says("Name of the monitor, as the window's log lists them; left out, "
                             "one that the operator's window is not on."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Checks that it is a rectangle that its eyes see from the front.
void check(const Display& display, Diagnostics& diagnostics);

}  // namespace dihaptic::display
