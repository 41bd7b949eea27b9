// Calibration: finds the correction of each device from samples of its endpoint. The samples are
// taken while a link of constant, unknown length joins two endpoints, and while endpoints touch the
// points of a jig. README.md has the equations, the requirements on the movement, and the sources.
#pragma once

#include <string>
#include <vector>

#include "rig/correction.h"

namespace dihaptic::rig {

/// The entry for one device in a calibration file: the parameters of a Correction.
struct DeviceCalibration {
    std::string finger;
    std::string serial;         ///< serial number of the device; "" if it reports none
    Vec3 shift = Vec3::Zero();  ///< position of the true D in the D of the rig file [m]
    Vec3 turn = Vec3::Zero();   ///< rotation of the true D about x, then y, then z [rad]
    /// True minus reported joint angles [rad]. If unset, stretch and skew apply instead.
    std::optional<Vec3> joint_offset;
    Vec3 stretch = Vec3::Zero();  ///< stretch along x, y and z
    Vec3 skew = Vec3::Zero();     ///< skew in the yz, xz and xy planes
    /// Distance between this device's endpoint and the first device's when the two were held
    /// together [m]; unset for the first device, or if it was not measured.
    std::optional<double> together;

    template <class Visitor>
    void visit(Visitor& v) {
        v("finger", finger, Field::text().required());
        v("serial", serial);
        v("shift", shift, Field::length().within(-1, 1));
        v("turn", turn, Field::of(Quantity::angle).within(-7, 7));
        v("joint_offset", joint_offset, Field::of(Quantity::angle).within(-0.5, 0.5));
        v("stretch", stretch, Field::number().within(-0.5, 0.5));
        v("skew", skew, Field::number().within(-0.5, 0.5));
        v("together", together, Field::length().within(0, 1));
    }

    /// `arm` is the device's arm; its joints are used if `joint_offset` is set.
    Correction correction(const std::optional<model::PhantomLinks>& arm) const;
};

/// A calibration file.
struct Calibration {
    std::string date;  ///< in ISO 8601 format: 2026-11-21
    std::vector<DeviceCalibration> devices;
    double link_length = 0;  ///< [m]
    // the misfits are those of held-out samples, which were not used for the solution; slips are
    // left out
    double link_rms = 0;              ///< misfit along the link [m]
    double link_worst = 0;            ///< [m]
    double agreement_rms = 0;         ///< misfit between two endpoints held together, in space [m]
    std::optional<double> jig_rms;    ///< distance from the points of the jig [m]
    std::optional<double> jig_worst;  ///< [m]
    double slips = 0;                 ///< fraction of the link's samples that contradict the others
    Place place{};

    template <class Visitor>
    void visit(Visitor& v) {
        v("date", date, Field::text().required());
        v("devices", devices, Field::text().required());
        v("link_length", link_length, Field::length().within(0, 10));
        v("link_rms", link_rms, Field::length().within(0, 0.1));
        v("link_worst", link_worst, Field::length().within(0, 0.1));
        v("agreement_rms", agreement_rms, Field::length().within(0, 0.1));
        v("jig_rms", jig_rms, Field::length().within(0, 0.1));
        v("jig_worst", jig_worst, Field::length().within(0, 0.1));
        v("slips", slips, Field::number().within(0, 1));
    }

    /// The entry for the device of a finger; null if there is none.
    const DeviceCalibration* find(const std::string& finger) const;
};

/// Number of days between two dates in ISO 8601 format. Returns nullopt if one of them is not a
/// date.
std::optional<int> days_between(const std::string& from, const std::string& to);

/// What a device reports at one moment.
struct CalibrationReading {
    Vec3 p_DH = Vec3::Zero();    ///< [m]
    Vec3 joints = Vec3::Zero();  ///< [rad]
};

struct CalibrationInput {
    struct Device {
        std::string finger;
        std::string serial;
        Pose X_WD;  ///< pose according to the rig file
        std::optional<model::PhantomLinks> arm;
    };
    /// The endpoints of two devices joined by the link. Samples are ordered by time.
    struct LinkSample {
        size_t a = 0, b = 1;
        CalibrationReading at_a, at_b;
    };
    /// The endpoint of a device that touches a point of the jig.
    struct JigSample {
        size_t device = 0;
        CalibrationReading at;
        size_t point = 0;
    };
    std::vector<Device> devices;
    std::vector<Vec3> jig;  ///< the points of the jig, in the world [m]
    std::vector<LinkSample> link_samples;
    std::vector<JigSample> jig_samples;
    std::vector<LinkSample> together_samples;  ///< endpoints held together without the link
};

/// Distance between two endpoints minus the length of the link.
struct LinkResidual {
    Vec3 p_W = Vec3::Zero();  ///< middle of the link [m]
    double misfit = 0;        ///< [m]
    bool slip = false;
};

struct CalibrationResult {
    Calibration calibration;  ///< the calibration, without a date
    /// Residuals without corrections, with the median distance as the link's length.
    std::vector<LinkResidual> before;
    std::vector<LinkResidual> after;  ///< residuals of held-out samples, with corrections
};

/// Computes a calibration. Throws Error with a remedy if the movement was too short, too small or
/// too flat, or if the link's length varied.
CalibrationResult calibrate(const CalibrationInput& input);

/// Smallest extent that each device's cloud of endpoints must have along its thinnest direction
/// [m].
constexpr double kLeastDepth = 0.06;
constexpr size_t kLeastSamples = 300;

/// Extents of a cloud of points along its principal axes, smallest first, without the outermost
/// hundredth of the points at each end [m].
Vec3 cloud_extents(const std::vector<Vec3>& points);

/// Describes the result in words for a person, in several lines.
std::string describe(const CalibrationResult& result);

/// Extent of points along their second principal axis, i.e. twice the standard deviation [m]; 0 for
/// points on a line.
double across(const std::vector<Vec3>& points);
/// Smallest extent that a jig must have [m].
constexpr double kLeastJig = 0.03;

/// SVG text of a picture of the misfits over the workspace, seen from above, before and after
/// calibration.
std::string residual_picture(const CalibrationResult& result, const std::string& title);

}  // namespace dihaptic::rig
