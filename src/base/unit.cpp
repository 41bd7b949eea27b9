#include "base/unit.h"

#include <array>
#include <numbers>

namespace dihaptic {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

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
    std::string_view name;
    std::span<const Unit> units;
    std::string_view symbol;
};

Kind kind(Quantity quantity) {
    switch (quantity) {
        case Quantity::none:
            return {"number", {}, "1"};
        case Quantity::length:
            return {"length", kLength, "m"};
        case Quantity::angle:
            return {"angle", kAngle, "rad"};
        case Quantity::mass:
            return {"mass", kMass, "kg"};
        case Quantity::density:
            return {"density", kDensity, "kg/m^3"};
        case Quantity::time:
            return {"time", kTime, "s"};
        case Quantity::frequency:
            return {"frequency", kFrequency, "Hz"};
        case Quantity::speed:
            return {"speed", kSpeed, "m/s"};
        case Quantity::force:
            return {"force", kForce, "N"};
        case Quantity::stiffness:
            return {"stiffness", kStiffness, "N/m"};
        case Quantity::damping:
            return {"damping", kDamping, "N*s/m"};
        case Quantity::torque:
            return {"torque", kTorque, "N*m"};
        case Quantity::acceleration:
            return {"acceleration", kAcceleration, "m/s^2"};
        case Quantity::force_rate:
            return {"rate of force", kForceRate, "N/s"};
        case Quantity::stiffness_per_force:
            return {"stiffness per force", kStiffnessPerForce, "1/m"};
        case Quantity::turn_stiffness:
            return {"rotational stiffness", kTurnStiffness, "N*m/rad"};
        case Quantity::turn_damping:
            return {"rotational damping", kTurnDamping, "N*m*s/rad"};
        case Quantity::torque_rate:
            return {"rate of torque", kTorqueRate, "N*m/s"};
        case Quantity::inertia:
            return {"inertia", kInertia, "kg*m^2"};
    }
    return {"number", {}, "1"};
}

}  // namespace

std::span<const Unit> units(Quantity quantity) {
    return kind(quantity).units;
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
