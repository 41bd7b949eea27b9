// The rig: the devices, their poses, and the finger that holds each device (docs/files/rig.md).
#pragma once

#include "devices/device_claim.h"
#include "devices/device_group.h"
#include "display/display.h"
#include "display/headset.h"
#include "display/sound.h"
#include "host/hosted_devices.h"
#include "outlets/head_tracker.h"
#include "outlets/outlet.h"
#include "rig/calibration.h"

namespace dihaptic::rig {

struct Device {
    std::string finger;
    std::string backend;
    Vec3 position = Vec3::Zero();  ///< position of D's origin in the world [m]
    Vec3 rotation = Vec3::Zero();  ///< rotation about the world's axes x, then y, then z [rad]
    /// Factor from positions of the hand to positions in the world, about D's origin. Forces on the
    /// hand are smaller than those in the world by this factor (corrected_devices.h).
    double scale = 1;
    Node options;  ///< options, read by the backend
    Place place;

    template <class Visitor>
    void visit(Visitor& v) {
        v("finger", finger,
          Field::text().required().says("Finger of the scene that holds the device."));
        v("backend", backend, Field::text().required().says("Kind of device."));
        v("position", position,
          Field::length().within(-100, 100).says("Position of the device's origin."));
        v("rotation", rotation,
          Field::of(Quantity::angle)
              .within(-100, 100)
              .says("Rotation of the device about the world's axes x, then y, then z."));
        v("scale", scale,
          Field::number().within(0.1, 10).says("Ratio of movement in the world to movement of the "
                                               "hand, about the device's origin."));
        v("options", options, says("Options of the backend."));
    }

    Pose X_WD() const { return {rotation_xyz(rotation), position}; }
};

/// A point of known position in the world that endpoints can touch.
struct JigPoint {
    std::string name;
    Vec3 position = Vec3::Zero();  ///< [m]

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Name of the point."));
        v("position", position,
          Field::length().within(-10, 10).required().says("Position of the point."));
    }
};

/// The box within which hands are kept, if the rig file gives one. Its edges are parallel to the
/// world's axes. It replaces the workspaces of the individual devices.
struct Wall {
    Vec3 centre = Vec3::Zero();  ///< [m]
    Vec3 size = Vec3::Zero();    ///< [m]
    Place place{};

    template <class Visitor>
    void visit(Visitor& v) {
        v("centre", centre,
          Field::length().within(-100, 100).required().says(
              "Centre of the box in which hands are kept."));
        v("size", size,
          Field::length()
              .within(0.001, 100)
              .required()
              .says("Lengths of the box's edges, along the world's axes."));
    }
    Eigen::AlignedBox3d box() const { return {centre - size / 2, centre + size / 2}; }
};

/// Who named a rig file: the operator, or another file, which may come from a stranger.
enum class NamedBy { a_file, the_operator };

/// A rig file. All its positions are in one frame, in which `origin` is the position of the world's
/// origin. read_rig() subtracts `origin`, so it returns positions in the world.
struct Rig {
    std::string title;
    Vec3 origin = Vec3::Zero();  ///< origin of the world, in the file's frame [m]
    std::vector<Device> devices;
    std::optional<Wall> wall;
    std::vector<outlets::OutletConfig> outlets;
    /// Path of the calibration file, relative to the rig file's folder; empty if there is none.
    std::string calibration;
    std::vector<JigPoint> jig;
    std::vector<display::Display> displays;
    std::optional<outlets::TrackedHead> head;
    std::optional<display::Headset> headset;
    std::optional<display::Patch> patch;
    std::optional<display::SoundOutput> sound;  ///< unset for the system's default output
    Node settings;  ///< settings that this rig requires (frame::Settings)
    Place place;
    std::optional<Calibration> calibrated;  ///< content of the calibration file
    Vec3 moved_by = Vec3::Zero();           ///< the file's `origin` before it was set to zero [m]
    NamedBy named_by = NamedBy::a_file;  ///< decides whether its libraries are loaded (libraries.h)

    template <class Visitor>
    void visit(Visitor& v) {
        v("title", title, says("Title of the rig."));
        v("origin", origin,
          Field::length().within(-100, 100).says(
              "The world's origin, in the frame of all positions in this file."));
        v("devices", devices, Field::text().required().says("Devices, one for each finger."));
        v("wall", wall,
          says("Box in which hands are kept, in place of the reach that each device states."));
        v("outlets", outlets, says("Connections to the laboratory's other recording equipment."));
        v("calibration", calibration, says("Calibration file, relative to this file."));
        v("jig", jig, says("Points that endpoints can touch, for dihaptic calibrate."));
        v("displays", displays,
          says("Screens as the person sees them, and the person's eyes; if left out, the scene's "
               "camera "
               "determines the view."));
        v("head", head,
          says("Tracker of the person's head, with which tracked eyes of displays move; "
               "if left out, no head is tracked."));
        v("headset", headset,
          says("Headset that the person wears, and its position in the world; if left out, there "
               "is none."));
        v("patch", patch,
          says("Square for a photodiode, in a corner of the person's first display."));
        v("sound", sound,
          says("Output for the sounds of tasks; if left out, the system's default device."));
        v("settings", settings,
          says("Settings that the rig requires; those of 'safety' are its limits."));
    }
};

/// Reads a rig file with its calibration and registrations, and adds any problems to `diagnostics`.
Rig read_rig(const std::string& file, Diagnostics& diagnostics, NamedBy named_by = NamedBy::a_file);
/// Reads a rig without its registrations, which may be missing. Used for a rig whose displays are
/// to be registered.
Rig read_rig_to_register(const std::string& file, Diagnostics& diagnostics,
                         NamedBy named_by = NamedBy::a_file);
/// Reads a rig without its registrations and its calibration. Used for a rig that is to be
/// calibrated.
Rig read_rig_to_calibrate(const std::string& file, Diagnostics& diagnostics,
                          NamedBy named_by = NamedBy::a_file);

/// Path of a rig's calibration: the file named in the rig or, if the rig names none, a file next to
/// the rig file.
std::string calibration_file(const Rig& rig, const std::string& rig_file);
/// Throws Error if a calibration could not be stored in `file`. Must be called before samples are
/// taken.
void check_calibration_file(const std::string& rig_file, const std::string& file);
/// Writes a calibration, and a picture of its residuals next to it. Returns the picture's name.
/// Throws Error if the files cannot be written.
std::string store_calibration(const Rig& rig, const CalibrationResult& result,
                              const std::string& file);

/// The line with which a rig file names its calibration.
std::string calibration_line(const std::string& rig_file, const std::string& calibration_file);
/// Adds that line to a rig file that names no calibration.
void name_calibration(const std::string& rig_file, const std::string& calibration_file);

/// Whether the rig's devices are real, i.e. run in real time and move a person's hand.
bool is_real(const Rig& rig);

/// A rig that needs no file: an ideal simulated device for each finger.
Rig simulated_rig(const std::vector<std::string>& fingers, bool orientation = false);

/// Throws Error if the rig's jig is missing, or is too small to locate the devices. With several
/// devices, no jig is needed.
void check_jig(const Rig& rig);
/// Warns about a calibration or a display's registration that is older than kOldCalibration, and
/// about a display of a real rig that was never registered. `today` is in ISO 8601 format.
void check_age(const Rig& rig, const std::string& today, Diagnostics& diagnostics);
constexpr int kOldCalibration = 30;  // days

/// The rig without calibration and scales, so that its readings are what the devices report.
Rig uncorrected(const Rig& rig);

/// The information that the rig file gives on the fingers' devices, in the order of the fingers and
/// in world units. Touches no hardware: values that only an open device can report keep their
/// defaults. Throws Error if a finger has no device, or if options or the calibration are wrong.
std::vector<frame::DeviceInfo> describe(const Rig& rig, const std::vector<std::string>& fingers,
                                        const devices::Context& context);
/// Makes the devices for the scene's fingers, in the order of the fingers, corrected and scaled.
/// `keeping` says how a device host owns real devices; nullopt if this process owns them. Throws
/// Error if a finger has no device, or if the calibration belongs to other devices.
std::unique_ptr<devices::DeviceGroup> make_devices(
    const Rig& rig, const std::vector<std::string>& fingers, const devices::Context& context,
    const std::optional<host::Hosting>& hosting = {});
/// Claims the real devices that make_devices() made for this process. Must be called before they
/// are activated; a device host claims its devices itself. Throws Error if another program holds
/// one of them.
std::vector<devices::DeviceClaim> claim_devices(const Rig& rig,
                                                const std::vector<std::string>& fingers,
                                                const devices::DeviceGroup& devices);
/// The fingers that have a device, in the order of the file.
std::vector<std::string> held_fingers(const Rig& rig);
/// The display with this name or, if the name is empty, the only display. Throws Error if there is
/// no such display.
const display::Display& display_of(const Rig& rig, const std::string& name);
/// Path of a display's registration: the file named in the rig or, if the rig names none, a file
/// next to the rig file.
std::string registration_file(const display::Display& display, const std::string& rig_file);
/// The line with which a rig file names the registration of a display.
std::string registration_line(const std::string& rig_file, const std::string& registration_file);
/// Writes the registration of a display of this rig, in the frame of the rig file.
void store_registration(const Rig& rig, const display::Registration& registration,
                        const std::string& file);
/// The device that a finger holds. Throws Error if the finger holds none.
const Device& device_of(const Rig& rig, const std::string& finger);
/// The pose X_WD of each finger's device.
std::vector<Pose> poses(const Rig& rig, const std::vector<std::string>& fingers);
/// The box of the wall, in the world; nullopt if there is no wall.
std::optional<Eigen::AlignedBox3d> wall_box(const Rig& rig);

}  // namespace dihaptic::rig
