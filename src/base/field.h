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
// Reading (FieldReader), writing (FieldWriter) and everything else that needs names, units and
// bounds are visitors. An enum lists the names of its values once, in order, for argument-dependent
// lookup:
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
    bool above_min = false;  ///< the minimum itself is not allowed
    bool is_required = false;
    Tighter tighter = Tighter::none;
    const char* old_name = nullptr;  ///< name in older files
    std::string_view what = {};      ///< a sentence for docs/reference.md

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
    /// Both bounds are included. Bounds chosen for a tabletop catch a mistaken unit, which would
    /// otherwise show up as a simulation that diverges.
    constexpr Field within(double low, double high) const { return at_least(low).at_most(high); }
    constexpr Field tighter_when(Tighter way) const {
        Field f = *this;
        f.tighter = way;
        return f;
    }
    /// The field was renamed. A file with the old name is still read, with a warning that gives the
    /// new one.
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

/// A field with only a description.
constexpr Field says(std::string_view sentence) {
    return Field{}.says(sentence);
}

/// The texts of a field that accepts a single text or a list.
struct Texts : std::vector<std::string> {
    using std::vector<std::string>::vector;
};

/// A former name of an enum's value, which a file may still contain. Such an enum has
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

/// A struct that lists its fields for visitors of type V. Eigen's matrices, which have
/// a visit() of their own, are excluded.
template <class Struct, class V>
concept Described = !requires {
    Struct::RowsAtCompileTime;
}
&&requires(Struct& s, V& v) {
    s.visit(v);
};

/// The name of an enum's value in files and tables.
template <NamedEnum E>
constexpr std::string_view enum_name(E value) {
    return enum_names(value)[static_cast<size_t>(value)];
}
/// The value with this name; nullopt if there is none.
template <NamedEnum E>
constexpr std::optional<E> enum_named(std::string_view name) {
    constexpr auto names = enum_names(E{});
    for (size_t i = 0; i < names.size(); ++i) {
        if (name == names[i]) return static_cast<E>(i);
    }
    return std::nullopt;
}

}  // namespace dihaptic
