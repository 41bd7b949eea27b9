// The schema of a log has a line for each field of its frames, with the field's name, type and
// unit, in the order in which the fields are stored. The schema is part of the log's head;
// decoder.h uses it to read the log.
//
//   grip_force float64 N
//   fingers uint16 count, then each:
//     force_sent float64[3] N
//   bodies uint16 count, then uint16 index and item of each that changed:
//     position float64[3] m
#pragma once

#include <string>
#include <type_traits>

#include "base/clock.h"
#include "base/geometry.h"
#include "frame/term.h"

namespace dihaptic::recording {

/// The text that follows the name of a list.
constexpr const char* kEachFollows = "uint16 count, then each:";
constexpr const char* kChangedFollow =
    "uint16 count, then uint16 index and item of each that changed:";

template <class T>
constexpr const char* type_name() {
    if constexpr (std::is_enum_v<T>) return type_name<std::underlying_type_t<T>>();
    if constexpr (std::is_same_v<T, double>) return "float64";
    if constexpr (std::is_same_v<T, Vec3>) return "float64[3]";
    if constexpr (std::is_same_v<T, Quat>) return "float64[4] (x, y, z, w)";
    if constexpr (std::is_same_v<T, int64_t>) return "int64";
    if constexpr (std::is_same_v<T, int32_t>) return "int32";
    if constexpr (std::is_same_v<T, uint32_t>) return "uint32";
    if constexpr (std::is_same_v<T, Time>) return "int64";
    return "";
}

/// Returns the line that describes a field or a list, without its indentation.
template <class T>
std::string schema_line(const frame::Term& term) {
    return std::string(term.name) + " " + type_name<T>() + " " + term.unit;
}
inline std::string schema_line(const char* list, bool changed) {
    return std::string(list) + " " + (changed ? kChangedFollow : kEachFollows);
}

/// Returns the schema of the frames that this program writes.
std::string schema();

}  // namespace dihaptic::recording
