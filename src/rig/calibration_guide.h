// Leads a person through what a rig needs of one: its calibration, and before a session the proof
// that it still holds. Forces stay off.
#pragma once

#include <functional>

#include "rig/calibration_run.h"

namespace dihaptic::rig {

/// What the person is to do now, and how far that is.
struct Guidance {
    int step = 0;  ///< from 1; 0: there is nothing to do but to wait
    int steps = 0;
    std::string text;
    double share = 0;      ///< of what has to be measured
    std::string measured;  ///< in words; "" before anything is
};

/// Thrown by a guide when the person gives up.
struct GivenUp {};

/// Whoever stands between the program and the person. Called from the thread that leads, or from
/// one of a maker's library.
struct Guide {
    /// At each step's begin, and some times a second while something is measured.
    std::function<void(const Guidance& now)> show;
    /// In each tick: whether the person has said, since the last call, that the step is done.
    std::function<bool()> done;
};

/// Takes the samples of a calibration: of a person's movements, or, on simulated devices, of a
/// simulated hand's. Throws Error as make_devices() does, and when a device does not answer.
CalibrationInput lead_calibration(const Rig& rig, const Guide& guide);

/// Endpoints that are held together, against how they were when the rig was calibrated.
struct Together {
    /// Beyond what the calibration knows itself to be off by [m]: a person's fingers are not held
    /// twice in the same way.
    static constexpr double kMostApart = 1.5e-3;

    std::string first;   ///< finger
    std::string second;  ///< the other
    double apart = 0;    ///< distance of the endpoints [m]
    double before = 0;   ///< the same at calibration [m]
    bool agrees = false;

    /// A clause.
    std::string describe() const;
    /// Of one that does not agree.
    Problem warning(const Rig& rig) const;
};

/// Whether there is something to check: several real devices, and a calibration that knows of their
/// endpoints held together. `fingers`: that a session is about.
bool can_check_together(const Rig& rig, const std::vector<std::string>& fingers);
/// Measures for a second what the person holds together, on active devices that make_devices() made
/// for these fingers: activating them again could reset them. Throws what `guide` throws, and Error
/// when a device does not answer.
std::vector<Together> check_together(const Rig& rig, const std::vector<std::string>& fingers,
                                     devices::DeviceGroup& devices, const Guide& guide);

}  // namespace dihaptic::rig
