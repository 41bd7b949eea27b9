#include "devices/openhaptics/hd.h"

#include <fmt/format.h>

namespace dihaptic::devices::openhaptics {
namespace {

constexpr const char* kLookAtCable =
    "Check its cable, its power and, for a parallel port, its EPP mode";
constexpr const char* kGently = "Soften the coupling, or move more slowly";
constexpr const char* kMixedUp = "HD_FRAME_ERROR, its frames were mixed up";
constexpr const char* kReportThis = "Report this, with the session's folder";
constexpr const char* kNoCallback = "HD_SCHEDULER_FULL, the scheduler accepts no callback";
constexpr const char* kCloseOthers = "Close other programs that use OpenHaptics";

struct HdErrorRow {
    HdError code;
    const char* what;
    const char* remedy;
};

constexpr HdErrorRow kHdErrorRows[] = {
    {kHdInvalidValue, "HD_INVALID_VALUE, a value that it cannot accept", ""},
    {kHdInvalidOperation, "HD_INVALID_OPERATION, not possible now", ""},
    {kHdBadHandle, "HD_BAD_HANDLE, no such device",
     "Switch it on, and check its name in the driver's configuration"},
    {kHdWarmMotors, "HD_WARM_MOTORS, its motors are hot", "Let them cool, and press less hard"},
    {kHdExceededMaxForce, "HD_EXCEEDED_MAX_FORCE, more force than it can bear", kGently},
    {kHdExceededMaxImpulse, "HD_EXCEEDED_MAX_FORCE_IMPULSE, a force that rose too fast", kGently},
    {kHdExceededMaxVelocity, "HD_EXCEEDED_MAX_VELOCITY, it moved too fast", kGently},
    {kHdForceError, "HD_FORCE_ERROR, it cannot render force", "Switch it off and on"},
    {kHdDeviceFault, "HD_DEVICE_FAULT",
     "Switch it off and on, and run its manufacturer's diagnosis"},
    {kHdAlreadyInitiated, "HD_DEVICE_ALREADY_INITIATED, it is in use",
     "Close the other program that uses it, or correct options: name"},
    {kHdCommError, "HD_COMM_ERROR, the connection to it failed", kLookAtCable},
    {kHdCommConfigError, "HD_COMM_CONFIG_ERROR, the connection to it is configured wrongly",
     kLookAtCable},
    {kHdTimerError, "HD_TIMER_ERROR, the driver's clock failed", "Restart the machine"},
    {kHdIllegalBegin, kMixedUp, kReportThis},
    {kHdIllegalEnd, kMixedUp, kReportThis},
    {kHdFrameError, kMixedUp, kReportThis},
    {kHdInvalidPriority, kNoCallback, kCloseOthers},
    {kHdSchedulerFull, kNoCallback, kCloseOthers},
    {kHdInvalidLicence, "HD_INVALID_LICENSE, no valid licence was found",
     "Put the licence file's path into the environment variable OH_SDK_LICENSE_PATH"},
};

}  // namespace

HdErrorClass error_class(unsigned code) {
    switch (code) {
        case kHdSuccess:
            return HdErrorClass::none;
        case kHdWarmMotors:
        case kHdExceededMaxForce:
        case kHdExceededMaxImpulse:
        case kHdExceededMaxVelocity:
        case kHdForceError:
            return HdErrorClass::force;
        case kHdCommError:
        case kHdCommConfigError:
        case kHdTimerError:
        case kHdInvalidPriority:
        case kHdSchedulerFull:
            return HdErrorClass::scheduler;
        default:
            return HdErrorClass::device;
    }
}

HdErrorText describe_error(unsigned code) {
    if (code == kHdSuccess) return {};
    for (const HdErrorRow& row : kHdErrorRows) {
        if (row.code == code) return {row.what, row.remedy};
    }
    return {fmt::format("HD error {:#x}", code), "Look it up in OpenHaptics' reference"};
}

Hd load_hd(const std::string& path, const Place& place) {
    const std::string driver =
        "Install the device driver for this version of OpenHaptics, from 3D Systems, and run "
        "ldconfig.";
    const Library library(
        {"OpenHaptics",
         {"libHD.so", "libHD.so.3.4", "libHD.so.3.0"},
         true,
         "Install OpenHaptics 3.4 for Linux and the device driver from 3D Systems, and run "
         "ldconfig; or give the file's path as options: library.",
         {{"libPhantomIOLib42", driver},
          {"libPHANToMIO", driver},
          {"libncurses.so.5", "Install the package libncurses5."}}},
        path, place);
    Hd hd;
    hd.file = library.file();
    library.find("hdInitDevice", hd.init_device);
    library.find("hdDisableDevice", hd.disable_device);
    library.find("hdMakeCurrentDevice", hd.make_current);
    library.find("hdBeginFrame", hd.begin_frame);
    library.find("hdEndFrame", hd.end_frame);
    library.find("hdGetError", hd.get_error);
    library.find("hdEnable", hd.enable);
    library.find("hdDisable", hd.disable);
    library.find("hdIsEnabled", hd.is_enabled);
    library.find("hdGetIntegerv", hd.get_integers);
    library.find("hdGetDoublev", hd.get_doubles);
    library.find("hdSetDoublev", hd.set_doubles);
    library.find("hdGetString", hd.get_string);
    library.find("hdCheckCalibration", hd.check_calibration);
    library.find("hdUpdateCalibration", hd.update_calibration);
    library.find("hdStartScheduler", hd.start_scheduler);
    library.find("hdStopScheduler", hd.stop_scheduler);
    library.find("hdSetSchedulerRate", hd.set_scheduler_rate);
    library.find("hdScheduleAsynchronous", hd.schedule);
    library.find("hdUnschedule", hd.unschedule);
    return hd;
}

}  // namespace dihaptic::devices::openhaptics
