// Units of values in files. Inside the program everything is SI. In a file the key of a physical
// value names its unit: size_mm, mass_g, stiffness_N_m; any unit of the right kind is accepted.
#pragma once

#include <numbers>
#include <span>
#include <string>
#include <string_view>

namespace dihaptic {

constexpr double kDegree = std::numbers::pi / 180;  ///< [rad]

/// The kind of quantity that a value is. Values are written in the first unit of their kind.
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
};

struct Unit {
    std::string_view suffix;  ///< as in a key, e.g. "mm"
    double si;                ///< this unit in SI units
};

/// The units that a quantity may be given in, the SI unit first; empty for Quantity::none.
std::span<const Unit> units(Quantity quantity);

/// The unit of any quantity that has this suffix; null if there is none.
const Unit* find_unit(std::string_view suffix);

/// "length", "stiffness", ...: for messages.
std::string_view name(Quantity quantity);

/// The key that a value is written with, e.g. "size_m".
std::string si_key(std::string_view field, Quantity quantity);

/// The SI unit as people write it, e.g. "N/m"; "1" for Quantity::none.
std::string_view si_symbol(Quantity quantity);

}  // namespace dihaptic
