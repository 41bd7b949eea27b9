// Our own declarations of the part of Force Dimension's DHD API (libdhd, or libdrd, which contains
// it) that we use. Units are SI; every call identifies its device by a number, `id`.
#pragma once

#include <array>

#include "base/library.h"

namespace dihaptic::devices::forcedimension {

/// The array that dhdGetStatus() fills: 17 numbers in 3.17.5, with room for those of later
/// versions.
using DhdStatus = std::array<int, 64>;
enum DhdStatusIndex : unsigned {
    kDhdPower = 0,
    kDhdConnected = 1,
    kDhdReset = 3,  // needs calibration
    kDhdForce = 5,  // force is on
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

/// dhdSetWatchdog() accepts a number of steps. The largest number, and the length of a step [s]; 0
/// switches the watchdog off.
constexpr unsigned char kDhdLongestWatchdog = 255;
constexpr double kDhdWatchdogStep = 125e-6;

/// The library's functions. They return -1 for an error. Values of 0 and more are not errors: 1
/// means that the time guard returned the last state again, 2 that a motor is saturated.
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
    double (*max_force)(char id) = nullptr;   // negative: not stated
    double (*max_torque)(char id) = nullptr;  // negative: not stated
    int (*enable_expert_mode)() = nullptr;
    int (*disable_expert_mode)() = nullptr;
    int (*set_watchdog)(unsigned char steps, char id) = nullptr;  // in expert mode
    int (*status)(int*, char id) = nullptr;
    const char* (*last_error)() = nullptr;

    std::string file;  ///< from which the functions were loaded
};

/// Loads the library from `path`, or as found by the system if `path` is empty. Throws Error.
Dhd load_dhd(const std::string& path, const Place& place);

}  // namespace dihaptic::devices::forcedimension
