// Registration of a display finds the screen's position as seen by the person: a finger touches
// crosses on it. README.md describes the method and its accuracy.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/field.h"
#include "base/geometry.h"

namespace dihaptic::display {

struct Display;

/// A registration file. Its positions are in the same frame as those of the rig file; read_rig()
/// converts them all to the world's.
struct Registration {
    std::string date;                ///< ISO 8601: 2026-11-21
    Vec3 lower_left = Vec3::Zero();  ///< corners of the picture that the person sees [m]
    Vec3 lower_right = Vec3::Zero();
    Vec3 upper_left = Vec3::Zero();
    double rms = 0;    ///< deviation of the touches from the crosses [m]
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

/// A cross on the screen, in fractions of its edges from the lower left corner as seen.
struct Cross {
    double right = 0;
    double up = 0;
};
/// Four rows of five, starting at the upper left.
std::vector<Cross> crosses();

struct RegistrationResult {
    Registration registration;  ///< without a date
    double moved = 0;           ///< displacement of the screen's centre from the rig file [m]
    double turned = 0;          ///< rotation of the screen from the rig file [rad]
    double stretch = 0;         ///< touched size over the file's size, minus 1
};

/// The position of a screen whose crosses were touched at `touches` [m], one for each of crosses():
/// the rig file's screen, moved and turned as a whole. Throws Error when touches contradict each
/// other or the screen's size.
RegistrationResult register_screen(const Display& display, std::span<const Vec3> touches);
/// The result in words, for a person; several lines.
std::string describe(const RegistrationResult& result);

/// A picture of the crosses with their numbers (SVG), for the whole screen. It is
/// flipped for the mirror, and the same for both eyes.
std::string cross_picture(const Display& display);

}  // namespace dihaptic::display
