#include "devices/openhaptics/hd.h"

#include <fmt/format.h>

namespace dihaptic::devices::openhaptics {

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
    const std::string cables =
        "Look at its cable, its power and, of a parallel port, that it is in EPP mode";
    const std::string gently = "Soften the coupling, or move more slowly";
    switch (code) {
        case kHdSuccess:
            return {};
        case kHdInvalidValue:
            return {"HD_INVALID_VALUE, a value that it cannot take", ""};
        case kHdInvalidOperation:
            return {"HD_INVALID_OPERATION, not now", ""};
        case kHdBadHandle:
            return {"HD_BAD_HANDLE, no such device",
                    "Switch it on, and look for its name in the driver's configuration"};
        case kHdWarmMotors:
            return {"HD_WARM_MOTORS, its motors are hot", "Let them cool, and press less"};
        case kHdExceededMaxForce:
            return {"HD_EXCEEDED_MAX_FORCE, more force than it bears", gently};
        case kHdExceededMaxImpulse:
            return {"HD_EXCEEDED_MAX_FORCE_IMPULSE, a force that rose too fast", gently};
        case kHdExceededMaxVelocity:
            return {"HD_EXCEEDED_MAX_VELOCITY, it moved too fast", gently};
        case kHdForceError:
            return {"HD_FORCE_ERROR, it cannot give force", "Switch it off and on"};
        case kHdDeviceFault:
            return {"HD_DEVICE_FAULT", "Switch it off and on, and run its maker's diagnosis"};
        case kHdAlreadyInitiated:
            return {"HD_DEVICE_ALREADY_INITIATED, it is in use",
                    "Close the other program that uses it, or correct options: name"};
        case kHdCommError:
            return {"HD_COMM_ERROR, the connection to it failed", cables};
        case kHdCommConfigError:
            return {"HD_COMM_CONFIG_ERROR, the connection to it is set up wrongly", cables};
        case kHdTimerError:
            return {"HD_TIMER_ERROR, the driver's clock failed", "Restart the machine"};
        case kHdIllegalBegin:
        case kHdIllegalEnd:
        case kHdFrameError:
            return {"HD_FRAME_ERROR, its frames were mixed up",
                    "Report this, with the session's folder"};
        case kHdInvalidPriority:
        case kHdSchedulerFull:
            return {"HD_SCHEDULER_FULL, the scheduler takes no callback",
                    "Close other programs that use OpenHaptics"};
        case kHdInvalidLicence:
            return {"HD_INVALID_LICENSE, no valid licence was found",
                    "Name the licence's file in the environment variable OH_SDK_LICENSE_PATH"};
        default:
            return {fmt::format("HD error {:#x}", code), "Look it up in OpenHaptics' reference"};
    }
}

Hd load_hd(const std::string& path, const Place& place) {
    const std::string driver =
        "Install the device driver that belongs to this OpenHaptics, from 3D Systems, and run "
        "ldconfig.";
    const Library library(
        {"OpenHaptics",
         {"libHD.so", "libHD.so.3.4", "libHD.so.3.0"},
         true,
         "Install OpenHaptics 3.4 for Linux and the device driver from 3D Systems, and run "
         "ldconfig; or say where the file is, options: library.",
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
