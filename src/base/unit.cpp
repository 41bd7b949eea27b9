#include "base/unit.h"

#include <array>

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
