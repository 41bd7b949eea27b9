// Units of values in files. Inside the program everything is SI. In a file the key of a physical
// value names its unit: size_mm, mass_g, stiffness_N_m; any unit of the right kind is accepted.
#pragma once

#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace dihaptic {

constexpr double kDegree = std::numbers::pi / 180;  ///< [rad]

/// The kind of a quantity. Values are written in the first unit of their kind.
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
    std::string_view suffix;  ///< as in a key, e.g. "mm"
    double si;                ///< this unit in SI units
};

/// The exponents of metre, kilogram and second in a unit. Angles are pure numbers, in radians.
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

/// The units in which a quantity may be given, the SI unit first; empty for Quantity::none.
std::span<const Unit> units(Quantity quantity);

/// The unit of any quantity that has this suffix; null if there is none.
const Unit* find_unit(std::string_view suffix);

/// A unit that may follow a number in an expression, by its suffix (mm, N_m), in SI units.
struct UnitInSi {
    double si = 1;
    Dimension dimension;
};
/// Nullopt if no quantity has a unit with this suffix.
std::optional<UnitInSi> find_unit_in_si(std::string_view suffix);

/// The dimension of a unit in the usual notation: "N*s/m", "1", "ns". The unit must be composed of
/// m, kg, s, ns, N, Hz, rad and 1.
UnitInSi unit_in_si(std::string_view symbol);
Dimension dimension(Quantity quantity);
/// The SI unit in the usual notation, e.g. "N/m"; "1" for a pure number.
std::string si_symbol(const Dimension& dimension);
/// A name with its unit, e.g. "wait_ms".
struct NameInUnit {
    std::string_view name;  ///< without its unit, if it has one
    Quantity quantity = Quantity::none;
    double si = 1;  ///< its unit in SI units
};
NameInUnit split_unit(std::string_view key);

/// "length", "stiffness", ...: for messages.
std::string_view name(Quantity quantity);

/// The key with which a value is written, e.g. "size_m".
std::string si_key(std::string_view field, Quantity quantity);

/// The SI unit in the usual notation, e.g. "N/m"; "1" for Quantity::none.
std::string_view si_symbol(Quantity quantity);

}  // namespace dihaptic
