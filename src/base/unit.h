// Units of values in files. Inside the program, all values are in SI units. In a file, the key of a
// physical value includes the unit: size_mm, mass_g, stiffness_N_m; any unit of the right kind is
// accepted.
#pragma once

#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace dihaptic {

constexpr double kDegree = std::numbers::pi / 180;  ///< [rad]

/// The kind of a quantity. Values are written in the first unit listed for their kind.
enum class Quantity {
    none,  ///< a pure number: the key has no unit
    length,
    angle,
    mass,
    density,
    time,
    frequency,
    speed,
    force,
    stiffness,
    damping,
    torque,
    acceleration,
    force_rate,
    stiffness_per_force,
    turn_stiffness,
    turn_damping,
    torque_rate,
    inertia,
    pressure,
    angular_speed,
};

struct Unit {
    std::string_view suffix;  ///< the form used in a key, e.g. "mm"
    double si;                ///< value of this unit in SI units
};

/// The exponents of metre, kilogram and second in a unit. Angles are pure numbers, measured in
/// radians.
struct Dimension {
    int m = 0;
    int kg = 0;
    int s = 0;

    bool operator==(const Dimension&) const = default;
    constexpr Dimension operator*(const Dimension& other) const {
        return {m + other.m, kg + other.kg, s + other.s};
    }
    constexpr Dimension operator/(const Dimension& other) const {
        return {m - other.m, kg - other.kg, s - other.s};
    }
};

/// The units in which a quantity may be given, with the SI unit first; empty for Quantity::none.
std::span<const Unit> units(Quantity quantity);

/// The unit with this suffix, for any quantity; null if there is none.
const Unit* find_unit(std::string_view suffix);

/// A unit that may follow a number in an expression, found by its suffix (mm, N_m), expressed in SI
/// units.
struct UnitInSi {
    double si = 1;
    Dimension dimension;
};
/// The unit with this suffix; nullopt if no quantity has such a unit.
std::optional<UnitInSi> find_unit_in_si(std::string_view suffix);

/// A unit in the usual notation, e.g. "N*s/m", "1" or "ns", expressed in SI units. The unit must be
/// composed of m, kg, s, ns, N, Hz, rad and 1.
UnitInSi unit_in_si(std::string_view symbol);
Dimension dimension(Quantity quantity);
/// The SI unit with this dimension in the usual notation, e.g. "N/m"; "1" for a pure number.
std::string si_symbol(const Dimension& dimension);
/// A name that may end with a unit, e.g. "wait_ms".
struct NameInUnit {
    std::string_view name;  ///< the name without its unit, if it has one
    Quantity quantity = Quantity::none;
    double si = 1;  ///< value of the unit in SI units
};
NameInUnit split_unit(std::string_view key);

/// The name of a quantity for use in messages: "length", "stiffness", ...
std::string_view name(Quantity quantity);

/// The key under which a value is written, e.g. "size_m".
std::string si_key(std::string_view field, Quantity quantity);

/// The SI unit of a quantity in the usual notation, e.g. "N/m"; "1" for Quantity::none.
std::string_view si_symbol(Quantity quantity);

}  // namespace dihaptic
