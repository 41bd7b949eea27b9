// Registers a display, i.e. finds the position of the screen as the person sees it, from crosses on
// the screen that a finger has touched. README.md describes the method and its accuracy.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/field.h"
#include "base/geometry.h"

namespace dihaptic::display {

struct Display;

/// The contents of a registration file. Its positions are in the same frame as those of the rig
/// file; read_rig() converts all of them to world coordinates.
struct Registration {
    std::string date;                ///< ISO 8601 date, e.g. 2026-11-21
    Vec3 lower_left = Vec3::Zero();  ///< corners of the picture as the person sees it [m]
    Vec3 lower_right = Vec3::Zero();
    Vec3 upper_left = Vec3::Zero();
    double rms = 0;    ///< deviation of the touched positions from the crosses [m]
    double worst = 0;  ///< [m]
    Place place{};

    void move(const Vec3& by) {
        for (Vec3* corner : {&lower_left, &lower_right, &upper_left}) *corner += by;
    }

    template <class Visitor>
    void visit(Visitor& v) {
        const Field corner = Field::length().within(-100, 100).required();
        v("date", date, Field::text().required());
        v("lower_left", lower_left, corner);
        v("lower_right", lower_right, corner);
        v("upper_left", upper_left, corner);
        v("rms", rms, Field::length().within(0, 0.1));
        v("worst", worst, Field::length().within(0, 0.1));
    }
};

/// A cross on the screen. Its position is given in fractions of the screen's edges, starting from
/// the lower left corner as the person sees it.
struct Cross {
    double right = 0;
    double up = 0;
};
/// Returns the crosses: four rows of five, starting at the upper left.
std::vector<Cross> crosses();

struct RegistrationResult {
    Registration registration;  ///< the registration, without a date
    double moved = 0;    ///< displacement of the screen's centre relative to the rig file [m]
    double turned = 0;   ///< rotation of the screen relative to the rig file [rad]
    double stretch = 0;  ///< ratio of the touched size to the size in the rig file, minus 1
};

/// Finds the position of a screen whose crosses were touched at `touches` [m], one for each of
/// crosses(). The screen of the rig file is moved and turned as a whole. Throws Error when the
/// touches contradict each other or the size of the screen.
RegistrationResult register_screen(const Display& display, std::span<const Vec3> touches);
/// Describes the result in words, in several lines.
std::string describe(const RegistrationResult& result);

/// Returns a picture (SVG) of the crosses with their numbers, for the whole screen. The picture is
/// flipped if there is a mirror, and is the same for both eyes.
std::string cross_picture(const Display& display);

}  // namespace dihaptic::display
