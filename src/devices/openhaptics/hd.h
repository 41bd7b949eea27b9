// Dihaptic's own declarations of the parts of OpenHaptics' HD API (libHD) that it uses. Units are
// mm, mm/s, N, mN*m and rad. The x axis points to the right, y upwards, and z toward the person.
#pragma once

#include "base/library.h"

namespace dihaptic::devices::openhaptics {

constexpr double kPerMm = 1e-3;  // [m]

using HdHandle = unsigned;
constexpr HdHandle kNoHandle = 0xFFFFFFFF;

/// The newest error on the stack that all threads share. At most kMostErrors errors are taken at a
/// time, so that a stack that never becomes empty does not block the program.
struct HdErrorInfo {
    unsigned code;  ///< HdError
    int internal;
    HdHandle device;
};

constexpr int kMostErrors = 64;

using HdCallback = unsigned (*)(void* data);
enum HdCallbackCode : unsigned { kHdDone = 0, kHdContinue = 1 };
constexpr unsigned short kHdHighestPriority = 65535;

enum HdValue : unsigned {
    kHdButtons = 0x2000,          // int, one bit per button
    kHdPosition = 0x2050,         // 3 doubles
    kHdVelocity = 0x2051,         // 3 doubles
    kHdTransform = 0x2052,        // 16 doubles, in column-major order
    kHdAngularVelocity = 0x2053,  // 3 doubles
    kHdJointAngles = 0x2100,      // 3 doubles: turret to the left, thigh up, shin up [rad]
    kHdVersion = 0x2500,          // a string, like the next two values
    kHdModel = 0x2501,
    kHdSerial = 0x2504,
    kHdUsableWorkspace = 0x2551,   // 6 doubles: the three minima, then the three maxima
    kHdInputDof = 0x2553,          // int
    kHdOutputDof = 0x2554,         // int
    kHdCalibrationStyle = 0x2555,  // int: a sum of HdCalibrationStyle values
    kHdMaxStiffness = 0x2602,      // double [N/mm]
    kHdMaxForce = 0x2603,          // double
    kHdMaxContinuousForce = 0x2604,
    kHdMaxDamping = 0x2609,  // double [N*s/mm]
    kHdMaxTorque = 0x2622,   // double
    kHdMaxContinuousTorque = 0x2623,
    kHdForce = 0x2700,   // 3 doubles
    kHdTorque = 0x2701,  // 3 doubles, about the same axes as the force
};

enum HdCapability : unsigned { kHdForceOutput = 0x4000, kHdForceRamping = 0x4002 };

enum HdCalibration : unsigned { kHdOk = 0x5000, kHdNeedsUpdate = 0x5001, kHdNeedsHand = 0x5002 };
enum HdCalibrationStyle : unsigned { kHdEncoderReset = 1, kHdAuto = 2, kHdInkwell = 4 };

enum HdError : unsigned {
    kHdSuccess = 0,
    kHdInvalidValue = 0x101,
    kHdInvalidOperation = 0x102,
    kHdBadHandle = 0x104,
    kHdWarmMotors = 0x200,
    kHdExceededMaxForce = 0x201,
    kHdExceededMaxImpulse = 0x202,
    kHdExceededMaxVelocity = 0x203,
    kHdForceError = 0x204,
    kHdDeviceFault = 0x300,
    kHdAlreadyInitiated = 0x301,
    kHdCommError = 0x302,
    kHdCommConfigError = 0x303,
    kHdTimerError = 0x304,
    kHdIllegalBegin = 0x400,
    kHdIllegalEnd = 0x401,
    kHdFrameError = 0x402,
    kHdInvalidPriority = 0x500,
    kHdSchedulerFull = 0x501,
    kHdInvalidLicence = 0x600,
};

/// What an error means for a session.
enum class HdErrorClass {
    none,
    force,      ///< the device cut its force, which can be switched on again after writing zero
    scheduler,  ///< the device or the loop is lost
    device,     ///< any other error
};
HdErrorClass error_class(unsigned code);
/// The name of an error, and the remedy.
struct HdErrorText {
    std::string what;
    std::string remedy;
};
HdErrorText describe_error(unsigned code);

/// The functions of the library.
struct Hd {
    HdHandle (*init_device)(const char* name) = nullptr;
    void (*disable_device)(HdHandle) = nullptr;
    void (*make_current)(HdHandle) = nullptr;
    void (*begin_frame)(HdHandle) = nullptr;
    void (*end_frame)(HdHandle) = nullptr;
    HdErrorInfo (*get_error)() = nullptr;
    void (*enable)(unsigned capability) = nullptr;
    void (*disable)(unsigned capability) = nullptr;
    unsigned char (*is_enabled)(unsigned capability) = nullptr;
    void (*get_integers)(unsigned value, int*) = nullptr;
    void (*get_doubles)(unsigned value, double*) = nullptr;
    void (*set_doubles)(unsigned value, const double*) = nullptr;
    const char* (*get_string)(unsigned value) = nullptr;
    unsigned (*check_calibration)() = nullptr;
    void (*update_calibration)(unsigned style) = nullptr;
    void (*start_scheduler)() = nullptr;
    void (*stop_scheduler)() = nullptr;
    void (*set_scheduler_rate)(unsigned long hz) = nullptr;
    unsigned long (*schedule)(HdCallback, void* data, unsigned short priority) = nullptr;
    void (*unschedule)(unsigned long) = nullptr;

    std::string file;  ///< the file from which the functions were loaded
};

/// Loads the library from `path` or, if `path` is empty, from wherever the system finds it. Throws
/// Error if it cannot be loaded.
Hd load_hd(const std::string& path, const Place& place);

}  // namespace dihaptic::devices::openhaptics
