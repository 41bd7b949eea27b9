#include "devices/forcedimension/dhd.h"

namespace dihaptic::devices::forcedimension {

Dhd load_dhd(const std::string& path, const Place& place) {
    const Library library({"Force Dimension's SDK",
                           {"libdhd.so.3", "libdrd.so.3", "libdhd.so", "libdrd.so"},
                           false,
                           "Install the Force Dimension SDK 3 for Linux, and run ldconfig; or give "
                           "the file's path as options: library.",
                           {{"libusb-1.0", "Install the package libusb-1.0-0."}}},
                          path, place);
    Dhd dhd;
    dhd.file = library.file();
    library.find("dhdGetDeviceCount", dhd.device_count);
    library.find("dhdOpenID", dhd.open_id);
    library.find("dhdClose", dhd.close);
    library.find("dhdGetSystemName", dhd.system_name);
    library.find("dhdGetSerialNumber", dhd.serial_number);
    library.find("dhdEnableForce", dhd.enable_force);
    library.find("dhdGetPosition", dhd.position);
    library.find("dhdGetLinearVelocity", dhd.velocity);
    library.find("dhdSetForce", dhd.set_force);
    library.find("dhdHasWrist", dhd.has_wrist);
    library.find("dhdHasActiveWrist", dhd.has_active_wrist);
    library.find("dhdGetOrientationFrame", dhd.orientation);
    library.find("dhdGetAngularVelocityRad", dhd.angular_velocity);
    library.find("dhdSetForceAndTorque", dhd.set_force_and_torque);
    library.find("dhdGetButtonMask", dhd.buttons);
    library.find("dhdSetGravityCompensation", dhd.compensate_gravity);
    library.find("dhdGetMaxForce", dhd.max_force);
    library.find("dhdGetMaxTorque", dhd.max_torque);
    library.find("dhdEnableExpertMode", dhd.enable_expert_mode);
    library.find("dhdDisableExpertMode", dhd.disable_expert_mode);
    library.find("dhdSetWatchdog", dhd.set_watchdog);
    library.find("dhdGetStatus", dhd.status);
    library.find("dhdErrorGetLastStr", dhd.last_error);
    return dhd;
}

}  // namespace dihaptic::devices::forcedimension
