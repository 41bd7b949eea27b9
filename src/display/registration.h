// Registration of a display finds out where the person sees its screen, by a finger that touches
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
    Vec3 lower_left = Vec3::Zero();  ///< corners of what the person sees [m]
    Vec3 lower_right = Vec3::Zero();
    Vec3 upper_left = Vec3::Zero();
    double rms = 0;    ///< of the touches from the crosses [m]
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
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// A cross on the screen, in shares of its edges from what the person sees as its lower left.
struct Cross {
    double right = 0;
    double up = 0;
};
/// Four rows of five, from the upper left on.
std::vector<Cross> crosses();

struct RegistrationResult {
    Registration registration;  ///< without a date
    double moved = 0;           ///< the screen's middle, from where the rig file has it [m]
    double turned = 0;          ///< the screen, from how the rig file has it [rad]
    double stretch = 0;         ///< what was touched over the size that the file says, less 1
};

/// The place of a screen whose crosses were touched at `touches` [m], one for each of crosses():
/// the rig file's screen, moved and turned as a whole. Throws Error when touches contradict each
/// other or the screen's size.
RegistrationResult register_screen(const Display& display, std::span<const Vec3> touches);
/// The result in words, for a person; several lines.
std::string describe(const RegistrationResult& result);

/// A picture of the crosses with their numbers (SVG), to be shown on the whole screen. It is
/// flipped for the mirror, and the same for both eyes.
std::string cross_picture(const Display& display);

}  // namespace dihaptic::display
