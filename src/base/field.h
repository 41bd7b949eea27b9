// A configuration struct describes itself by listing its fields once:
//
//     struct Ball {
//         double radius = 0.02;  ///< [m]
//         double friction = 0.8;
//
//         template <class Visitor>
//         void visit(Visitor& v) {
//             v("radius", radius, Field::length().positive().says("Radius of the ball."));
//             v("friction", friction, Field::number().at_least(0));
//         }
//     };
//
// Readers (FieldReader), writers (FieldWriter) and everything else that needs names, units and
// bounds are implemented as visitors. An enum lists the names of its values once, in their order,
// in a function that is found by argument-dependent lookup:
//
//     constexpr auto enum_names(Shape) { return std::array{"box", "sphere"}; }
//
#pragma once

#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/unit.h"

namespace dihaptic {

/// The direction in which a limit becomes tighter. Once a limit is set, later settings can only
/// move it in that direction, or, if it is `fixed`, not at all.
enum class Tighter { none, less, more, fixed };

/// The conditions on a field's value, or on each component of a vector.
struct Field {
    Quantity quantity = Quantity::none;
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool above_min = false;  ///< whether the minimum itself is excluded
    bool is_required = false;
    Tighter tighter = Tighter::none;
    const char* old_name = nullptr;  ///< the field's name in older files
    std::string_view what = {};      ///< a sentence that describes the field in docs/reference.md

    static constexpr Field number() { return {}; }
    static constexpr Field text() { return {}; }
    static constexpr Field of(Quantity q) { return {.quantity = q}; }
    static constexpr Field length() { return of(Quantity::length); }

    constexpr Field positive() const {
        Field f = *this;
        f.min = 0;
        f.above_min = true;
        return f;
    }
    constexpr Field at_least(double low) const {
        Field f = *this;
        f.min = low;
        return f;
    }
    constexpr Field at_most(double high) const {
        Field f = *this;
        f.max = high;
        return f;
    }
    /// A range that includes both bounds. The bounds are chosen for a tabletop, so they reveal a
    /// mistaken unit, which would otherwise show up as a diverging simulation.
    constexpr Field within(double low, double high) const { return at_least(low).at_most(high); }
    constexpr Field tighter_when(Tighter way) const {
        Field f = *this;
        f.tighter = way;
        return f;
    }
    /// Gives the field's former name. A file with that name can still be read, with a warning that
    /// states the new name.
    constexpr Field formerly(const char* name) const {
        Field f = *this;
        f.old_name = name;
        return f;
    }
    constexpr Field required() const {
        Field f = *this;
        f.is_required = true;
        return f;
    }
    constexpr Field says(std::string_view sentence) const {
        Field f = *this;
        f.what = sentence;
        return f;
    }
};

/// A field that has only a description.
constexpr Field says(std::string_view sentence) {
    return Field{}.says(sentence);
}

/// The texts in a field that accepts either a single text or a list of texts.
struct Texts : std::vector<std::string> {
    using std::vector<std::string>::vector;
};

/// A former name of an enum value, which files may still contain. An enum with a former name
/// defines
///
///     constexpr OldName old_name(Shape) { return {"cube", "Write box."}; }
struct OldName {
    std::string_view was;
    std::string_view remedy;
};

template <class E>
concept NamedEnum = std::is_enum_v<E> && requires(E e) {
    enum_names(e);
};

/// A struct that lists its fields for visitors of type V. Eigen's matrices are excluded because
/// they have a visit() of their own.
template <class Struct, class V>
concept Described = !requires {
    Struct::RowsAtCompileTime;
}
&&requires(Struct& s, V& v) {
    s.visit(v);
};

/// The name of an enum value, as used in files and tables.
template <NamedEnum E>
constexpr std::string_view enum_name(E value) {
    return enum_names(value)[static_cast<size_t>(value)];
}
/// The enum value with this name; nullopt if there is none.
template <NamedEnum E>
constexpr std::optional<E> enum_named(std::string_view name) {
    constexpr auto names = enum_names(E{});
    for (size_t i = 0; i < names.size(); ++i) {
        if (name == names[i]) return static_cast<E>(i);
    }
    return std::nullopt;
}

}  // namespace dihaptic
