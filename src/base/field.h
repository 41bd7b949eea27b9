// How configuration is described. A configuration struct lists its fields once:
//
//     struct Ball {
//         double radius = 0.02;  ///< [m]
//         double friction = 0.8;
//
//         template <class Visitor>
//         void visit(Visitor& v) {
//             v("radius", radius, Field::length().positive());
//             v("friction", friction, Field::number().at_least(0));
//         }
//     };
//
// and reading (FieldReader), writing (FieldWriter) and whatever else needs names, units and bounds
// are visitors. An enum lists its names once, for argument-dependent lookup:
//
//     constexpr auto enum_names(Shape) { return std::array{"box", "sphere"}; }   // in the enum's
//     order
//
#pragma once

#include <concepts>
#include <limits>
#include <string_view>

#include "base/unit.h"

namespace dihaptic {

/// Which way a limit is tighter, of settings that are limits: whoever set it first may be outdone
/// that way only. `fixed`: neither way.
enum class Tighter { none, less, more, fixed };

/// What a field's value must be. A vector's components each obey it.
struct Field {
    Quantity quantity = Quantity::none;
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool above_min = false;  ///< the minimum itself is not allowed
    bool is_required = false;
    Tighter tighter = Tighter::none;

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
    /// Both bounds included. Limits of what makes sense on a tabletop catch slips of the unit that
    /// would otherwise surface as a simulation that diverges.
    constexpr Field within(double low, double high) const { return at_least(low).at_most(high); }
    constexpr Field tighter_when(Tighter way) const {
        Field f = *this;
        f.tighter = way;
        return f;
    }
    constexpr Field required() const {
        Field f = *this;
        f.is_required = true;
        return f;
    }
};

template <class E>
concept NamedEnum = std::is_enum_v<E> && requires(E e) {
    enum_names(e);
};

/// A struct that lists its fields for visitors of type V. (Eigen's matrices have a visit() of their
/// own.)
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

}  // namespace dihaptic
