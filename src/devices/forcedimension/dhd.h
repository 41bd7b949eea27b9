// Dihaptic's own declarations of the parts of Force Dimension's DHD API that it uses (libdhd, or
// libdrd, which contains libdhd). All units are SI units; every call identifies its device by the
// number `id`.
#pragma once

#include <array>

#include "base/library.h"

namespace dihaptic::devices::forcedimension {

/// The array that dhdGetStatus() fills: 17 numbers in version 3.17.5, with room for the additional
/// numbers of later versions.
using DhdStatus = std::array<int, 64>;
enum DhdStatusIndex : unsigned {
    kDhdPower = 0,
    kDhdConnected = 1,
    kDhdReset = 3,  // needs calibration
    kDhdForce = 5,  // whether force is on
    kDhdBrake = 6,
    kDhdErrorIndex = 9,
    kDhdForceOffCause = 14,
};
enum DhdForceOff : int {
    kDhdByButton = 1,
    kDhdByVelocity = 2,
    kDhdByWatchdog = 3,
    kDhdBySoftware = 4,
    kDhdByUsb = 5,
    kDhdByDeadMan = 6,
};

/// Arguments of dhdSetWatchdog(), which takes a number of steps: the largest possible number, and
/// the length of a step [s]. A number of 0 switches the watchdog off.
constexpr unsigned char kDhdLongestWatchdog = 255;
constexpr double kDhdWatchdogStep = 125e-6;

/// The library's functions. They return -1 on error. Values of 0 or more are not errors: 1 means
/// that the time guard returned the previous state again, 2 that a motor is saturated.
struct Dhd {
    int (*device_count)() = nullptr;
    int (*open_id)(char id) = nullptr;
    int (*close)(char id) = nullptr;
    const char* (*system_name)(char id) = nullptr;
    int (*serial_number)(unsigned short*, char id) = nullptr;
    int (*enable_force)(unsigned char on, char id) = nullptr;
    int (*position)(double*, double*, double*, char id) = nullptr;
    int (*velocity)(double*, double*, double*, char id) = nullptr;
    int (*set_force)(double, double, double, char id) = nullptr;
    bool (*has_wrist)(char id) = nullptr;                        // measures orientation
    bool (*has_active_wrist)(char id) = nullptr;                 // renders torque
    int (*orientation)(double (*matrix)[3], char id) = nullptr;  // by rows
    int (*angular_velocity)(double*, double*, double*, char id) = nullptr;
    int (*set_force_and_torque)(double, double, double, double, double, double, char id) = nullptr;
    unsigned (*buttons)(char id) = nullptr;
    int (*compensate_gravity)(int on, char id) = nullptr;
    double (*max_force)(char id) = nullptr;   // negative if the device does not state it
    double (*max_torque)(char id) = nullptr;  // negative if the device does not state it
    int (*enable_expert_mode)() = nullptr;
    int (*disable_expert_mode)() = nullptr;
    int (*set_watchdog)(unsigned char steps, char id) = nullptr;  // available only in expert mode
    int (*status)(int*, char id) = nullptr;
    const char* (*last_error)() = nullptr;

    std::string file;  ///< the file from which the functions were loaded
};

/// Loads the library from `path` or, if `path` is empty, from wherever the system finds it. Throws
/// Error if it cannot be loaded.
Dhd load_dhd(const std::string& path, const Place& place);

}  // namespace dihaptic::devices::forcedimension
