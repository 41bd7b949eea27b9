// Calibration: finds the correction of each device from samples of its endpoint, taken while a link
// of constant, unknown length joined two endpoints and while endpoints touched the points of a jig.
// README.md has the equations, the limits of such a movement, and the sources.
#pragma once

#include <string>
#include <vector>

#include "rig/correction.h"

namespace dihaptic::rig {

/// One device's part of a calibration file: a Correction.
struct DeviceCalibration {
    std::string finger;
    std::string serial;         ///< serial number of the device; "" if the device reports none
    Vec3 shift = Vec3::Zero();  ///< shift of the true D in the rig file's D [m]
    Vec3 turn = Vec3::Zero();   ///< its rotation, about x, then y, then z [rad]
    /// True minus reported joint angles [rad]; unset: stretch and skew apply instead.
    std::optional<Vec3> joint_offset;
    Vec3 stretch = Vec3::Zero();  ///< along x, y, z
    Vec3 skew = Vec3::Zero();     ///< in yz, xz, xy
    /// Distance of the endpoint from the first device's when the two were held together [m]; unset
    /// for the first device, or without such a measurement.
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

    /// `arm`: the device's arm; its joints are used if `joint_offset` is set.
    Correction correction(const std::optional<model::PhantomLinks>& arm) const;
};

/// A calibration file.
struct Calibration {
    std::string date;  ///< ISO 8601: 2026-11-21
    std::vector<DeviceCalibration> devices;
    double link_length = 0;  ///< [m]
    // misfits are those of held-out samples, which the solution did not use; slips are left out
    double link_rms = 0;              ///< misfit along the link [m]
    double link_worst = 0;            ///< [m]
    double agreement_rms = 0;         ///< of two endpoints held together, in space [m]
    std::optional<double> jig_rms;    ///< distance from the jig's points [m]
    std::optional<double> jig_worst;  ///< [m]
    double slips = 0;                 ///< fraction of the link's samples that contradict the rest
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

    /// The entry of a finger's device; null if there is none.
    const DeviceCalibration* find(const std::string& finger) const;
};

/// Number of days from one ISO 8601 date to another. Returns nullopt when either is not a date.
std::optional<int> days_between(const std::string& from, const std::string& to);

/// A device's report at one moment.
struct CalibrationReading {
    Vec3 p_DH = Vec3::Zero();    ///< [m]
    Vec3 joints = Vec3::Zero();  ///< [rad]
};

struct CalibrationInput {
    struct Device {
        std::string finger;
        std::string serial;
        Pose X_WD;  ///< pose as in the rig file
        std::optional<model::PhantomLinks> arm;
    };
    /// The endpoints of two devices, joined. Samples are in order of time.
    struct LinkSample {
        size_t a = 0, b = 1;
        CalibrationReading at_a, at_b;
    };
    /// A device's endpoint on a point of the jig.
    struct JigSample {
        size_t device = 0;
        CalibrationReading at;
        size_t point = 0;
    };
    std::vector<Device> devices;
    std::vector<Vec3> jig;  ///< points of the jig, in the world [m]
    std::vector<LinkSample> link_samples;
    std::vector<JigSample> jig_samples;
    std::vector<LinkSample> together_samples;  ///< endpoints held together, without the link
};

/// Distance of two endpoints minus the link's length.
struct LinkResidual {
    Vec3 p_W = Vec3::Zero();  ///< middle of the link [m]
    double misfit = 0;        ///< [m]
    bool slip = false;
};

struct CalibrationResult {
    Calibration calibration;           ///< without a date
    std::vector<LinkResidual> before;  ///< uncorrected, with the median distance as the length
    std::vector<LinkResidual> after;   ///< corrected, of held-out samples
};

/// Throws Error with a remedy when the movement was too short, too small or too flat, or if the
/// link's length varied.
CalibrationResult calibrate(const CalibrationInput& input);

/// Smallest required extent of each device's cloud of endpoints, along its thinnest direction [m].
constexpr double kLeastDepth = 0.06;
constexpr size_t kLeastSamples = 300;

/// Extents of a cloud of points along its principal axes, without the outermost hundredth at each
/// end, the smallest first [m].
Vec3 cloud_extents(const std::vector<Vec3>& points);

/// The result in words, for a person; several lines.
std::string describe(const CalibrationResult& result);

/// Extent of points along their second principal axis, as twice the standard deviation [m]: 0 for
/// points on a line.
double across(const std::vector<Vec3>& points);
/// Smallest required extent of a jig [m].
constexpr double kLeastJig = 0.03;

/// SVG text: misfits over the workspace, seen from above, before and after.
std::string residual_picture(const CalibrationResult& result, const std::string& title);

}  // namespace dihaptic::rig
