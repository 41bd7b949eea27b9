#include "base/unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace dihaptic {
namespace {

constexpr std::array kLength{Unit{"m", 1}, Unit{"mm", 1e-3}, Unit{"cm", 1e-2}, Unit{"um", 1e-6}};
constexpr std::array kAngle{Unit{"rad", 1}, Unit{"deg", kDegree}};
constexpr std::array kMass{Unit{"kg", 1}, Unit{"g", 1e-3}};
constexpr std::array kDensity{Unit{"kg_m3", 1}, Unit{"g_cm3", 1e3}};
constexpr std::array kTime{Unit{"s", 1}, Unit{"ms", 1e-3}};
constexpr std::array kFrequency{Unit{"Hz", 1}, Unit{"kHz", 1e3}};
constexpr std::array kSpeed{Unit{"m_s", 1}, Unit{"mm_s", 1e-3}, Unit{"cm_s", 1e-2}};
constexpr std::array kForce{Unit{"N", 1}, Unit{"mN", 1e-3}};
constexpr std::array kStiffness{Unit{"N_m", 1}, Unit{"N_mm", 1e3}};
constexpr std::array kDamping{Unit{"Ns_m", 1}, Unit{"Ns_mm", 1e3}};
constexpr std::array kTorque{Unit{"Nm", 1}, Unit{"mNm", 1e-3}};
constexpr std::array kAcceleration{Unit{"m_s2", 1}};
constexpr std::array kForceRate{Unit{"N_s", 1}, Unit{"N_ms", 1e3}};
constexpr std::array kStiffnessPerForce{Unit{"1_m", 1}, Unit{"1_mm", 1e3}};
constexpr std::array kTurnStiffness{Unit{"Nm_rad", 1}, Unit{"mNm_rad", 1e-3}};
constexpr std::array kTurnDamping{Unit{"Nms_rad", 1}, Unit{"mNms_rad", 1e-3}};
constexpr std::array kTorqueRate{Unit{"Nm_s", 1}, Unit{"mNm_ms", 1}};
constexpr std::array kInertia{Unit{"kg_m2", 1}, Unit{"g_cm2", 1e-7}};
constexpr std::array kAngularSpeed{Unit{"rad_s", 1}, Unit{"deg_s", kDegree}};
constexpr std::array kPressure{Unit{"Pa", 1}, Unit{"kPa", 1e3}, Unit{"MPa", 1e6}};

struct Kind {
    Quantity quantity;
    std::string_view name;
    std::span<const Unit> units;
    std::string_view symbol;
};

constexpr std::array kKinds{
    Kind{Quantity::none, "number", {}, "1"},
    Kind{Quantity::length, "length", kLength, "m"},
    Kind{Quantity::angle, "angle", kAngle, "rad"},
    Kind{Quantity::mass, "mass", kMass, "kg"},
    Kind{Quantity::density, "density", kDensity, "kg/m^3"},
    Kind{Quantity::time, "time", kTime, "s"},
    Kind{Quantity::frequency, "frequency", kFrequency, "Hz"},
    Kind{Quantity::speed, "speed", kSpeed, "m/s"},
    Kind{Quantity::force, "force", kForce, "N"},
    Kind{Quantity::stiffness, "stiffness", kStiffness, "N/m"},
    Kind{Quantity::damping, "damping", kDamping, "N*s/m"},
    Kind{Quantity::torque, "torque", kTorque, "N*m"},
    Kind{Quantity::acceleration, "acceleration", kAcceleration, "m/s^2"},
    Kind{Quantity::force_rate, "rate of force", kForceRate, "N/s"},
    Kind{Quantity::stiffness_per_force, "stiffness per force", kStiffnessPerForce, "1/m"},
    Kind{Quantity::turn_stiffness, "rotational stiffness", kTurnStiffness, "N*m/rad"},
    Kind{Quantity::turn_damping, "rotational damping", kTurnDamping, "N*m*s/rad"},
    Kind{Quantity::torque_rate, "rate of torque", kTorqueRate, "N*m/s"},
    Kind{Quantity::inertia, "inertia", kInertia, "kg*m^2"},
    Kind{Quantity::pressure, "pressure", kPressure, "N/m^2"},
    Kind{Quantity::angular_speed, "angular speed", kAngularSpeed, "rad/s"},
};

constexpr bool in_order() {
    for (size_t i = 0; i < kKinds.size(); ++i) {
        if (kKinds[i].quantity != static_cast<Quantity>(i)) return false;
    }
    return true;
}
static_assert(in_order(), "a quantity is the index of its kind");

const Kind& kind(Quantity quantity) {
    return kKinds[static_cast<size_t>(quantity)];
}

}  // namespace

std::span<const Unit> units(Quantity quantity) {
    return kind(quantity).units;
}
const Unit* find_unit(std::string_view suffix) {
    for (const Kind& kind : kKinds) {
        for (const Unit& unit : kind.units) {
            if (unit.suffix == suffix) return &unit;
        }
    }
    return nullptr;
}
std::optional<UnitInSi> find_unit_in_si(std::string_view suffix) {
    for (const Kind& kind : kKinds) {
        for (const Unit& unit : kind.units) {
            if (unit.suffix == suffix) return UnitInSi{unit.si, unit_in_si(kind.symbol).dimension};
        }
    }
    return std::nullopt;
}

UnitInSi unit_in_si(std::string_view symbol) {
    struct Atom {
        std::string_view name;
        UnitInSi unit;
    };
    static constexpr std::array kAtoms{
        Atom{"1", {}},
        Atom{"rad", {}},
        Atom{"m", {1, {1, 0, 0}}},
        Atom{"kg", {1, {0, 1, 0}}},
        Atom{"s", {1, {0, 0, 1}}},
        Atom{"ns", {1e-9, {0, 0, 1}}},
        Atom{"N", {1, {1, 1, -2}}},
        Atom{"J", {1, {2, 1, -2}}},
        Atom{"Hz", {1, {0, 0, -1}}},
    };
    UnitInSi out;
    bool over = false;
    while (!symbol.empty()) {
        const std::string_view factor = symbol.substr(0, symbol.find_first_of("*/"));
        const std::string_view name = factor.substr(0, factor.find('^'));
        const int power = name.size() < factor.size() ? factor.back() - '0' : 1;
        const auto* atom = std::find_if(kAtoms.begin(), kAtoms.end(),
                                        [&](const Atom& known) { return known.name == name; });
        assert(atom != kAtoms.end());
        for (int i = 0; i < power; ++i) {
            const UnitInSi& by = atom->unit;
            out = over ? UnitInSi{out.si / by.si, out.dimension / by.dimension}
                       : UnitInSi{out.si * by.si, out.dimension * by.dimension};
        }
        symbol.remove_prefix(factor.size());
        over = symbol.starts_with('/');
        if (!symbol.empty()) symbol.remove_prefix(1);
    }
    return out;
}

Dimension dimension(Quantity quantity) {
    return unit_in_si(si_symbol(quantity)).dimension;
}

std::string si_symbol(const Dimension& dimension) {
    for (const Kind& kind : kKinds) {
        const bool angle = kind.quantity == Quantity::angle;
        if (!angle && unit_in_si(kind.symbol).dimension == dimension)
            return std::string(kind.symbol);
    }
    std::string out;
    const auto add = [&](std::string_view unit, int power) {
        if (power == 0) return;
        if (!out.empty()) out += '*';
        out += power == 1 ? std::string(unit) : fmt::format("{}^{}", unit, power);
    };
    add("kg", dimension.kg);
    add("m", dimension.m);
    add("s", dimension.s);
    return out;
}

NameInUnit split_unit(std::string_view key) {
    NameInUnit out{key};
    for (const Kind& kind : kKinds) {
        for (const Unit& unit : kind.units) {
            const size_t length = unit.suffix.size() + 1;
            // keeps the longest unit that matches: N_m rather than m
            if (key.size() <= length || key.size() - length >= out.name.size()) continue;
            if (key.ends_with(unit.suffix) && key[key.size() - length] == '_')
                out = {key.substr(0, key.size() - length), kind.quantity, unit.si};
        }
    }
    return out;
}
std::string_view name(Quantity quantity) {
    return kind(quantity).name;
}
std::string_view si_symbol(Quantity quantity) {
    return kind(quantity).symbol;
}

std::string si_key(std::string_view field, Quantity quantity) {
    std::string key(field);
    if (const auto all = units(quantity); !all.empty()) key.append("_").append(all.front().suffix);
    return key;
}

}  // namespace dihaptic
