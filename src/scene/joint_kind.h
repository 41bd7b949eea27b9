// The kinds of joints, in one table. A joint has a frame F on its first body and a frame G on its
// second body, both with the joint's axis along x at the start. The row of a kind states which
// motions of G relative to F the joint leaves free. It determines how files are checked, the
// equations (dynamics/bullet/joints.h), and how joints are recorded, driven by motors, placed in
// tasks and marked in pictures.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <vector>

namespace dihaptic::scene {

enum class JointKind { hinge, slider, ball, universal, fixed, distance, bushing };

/// How the origin of G may move relative to F.
enum class Sliding { none, along_axis, any };
/// How G may rotate relative to F. If there are two axes, the second is fixed in the second body.
enum class Turning { none, about_axis, about_two_axes, any };
/// The joint coordinate: the angle about the axis, the displacement along the axis, or the distance
/// between the two origins.
enum class Coordinate { none, angle, displacement, distance };

struct JointKindRow {
    const char* name;
    const char* noun;
    Sliding sliding;
    Turning turning;
    Coordinate coordinate;
    /// The free motion and the coordinate, in words for docs/files/joints.md.
    const char* leaves_free;
    const char* coordinate_is = "";
    bool yields = false;  ///< it opposes all motion with springs and dampers and prevents none

    constexpr bool has_coordinate() const { return coordinate != Coordinate::none; }
    /// Whether the coordinate is an angle about the axis or a displacement along it.
    constexpr bool has_axis() const {
        return has_coordinate() && coordinate != Coordinate::distance;
    }
};

/// The table of kinds, with a row for each JointKind in the same order.
constexpr JointKindRow kJointKindTable[] = {
    {"hinge", "a hinge", Sliding::none, Turning::about_axis, Coordinate::angle,
     "turning about `axis`", "the angle of the second body relative to the first, about the axis"},
    {"slider", "a slider", Sliding::along_axis, Turning::none, Coordinate::displacement,
     "sliding along `axis`",
     "distance moved by the second body along the axis, which the first body carries"},
    {"ball", "a ball joint", Sliding::none, Turning::any, Coordinate::none,
     "turning about its point"},
    {"universal", "a universal joint", Sliding::none, Turning::about_two_axes, Coordinate::none,
     "turning about `axis`, which the first body carries, and about `second_axis`, which the "
     "second carries"},
    {"fixed", "a fixed joint", Sliding::none, Turning::none, Coordinate::none, "nothing"},
    {"distance", "a distance joint", Sliding::any, Turning::any, Coordinate::distance,
     "everything except the distance between two points",
     "that distance, from `position` on the first body to `second_position` on the second"},
    {"bushing", "a bushing", Sliding::none, Turning::none, Coordinate::none,
     "everything, against a spring and a damper along and about each axis", "", true},
};
static_assert(std::size(kJointKindTable) == static_cast<size_t>(JointKind::bushing) + 1);
constexpr auto enum_names(JointKind) {
    std::array<const char*, std::size(kJointKindTable)> out{};
    std::transform(std::begin(kJointKindTable), std::end(kJointKindTable), out.begin(),
                   [](const JointKindRow& row) { return row.name; });
    return out;
}
constexpr const JointKindRow& describe(JointKind kind) noexcept {
    return kJointKindTable[static_cast<size_t>(kind)];
}

/// The kinds for which the given function is true, for use in messages: "a hinge, a slider or a
/// distance joint". There must be at least two.
inline std::string kinds_that(bool (JointKindRow::*fit)() const,
                              const char* JointKindRow::*word = &JointKindRow::noun,
                              const char* last = " or ") {
    std::vector<std::string> words;
    for (const JointKindRow& row : kJointKindTable) {
        if ((row.*fit)()) words.emplace_back(row.*word);
    }
    return fmt::format("{}{}{}", fmt::join(words.begin(), words.end() - 1, ", "), last,
                       words.back());
}

}  // namespace dihaptic::scene
