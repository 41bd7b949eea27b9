// Describes the simulated hand, as specified in scene and experiment files.
#pragma once

#include <string>
#include <vector>

#include "base/field_reader.h"

namespace dihaptic::hand {

/// Limits of a script. If they are exceeded, a unit is wrong.
constexpr double kLongestScript = 3600;  // [s]
constexpr double kFarthest = 100;        // [m]
constexpr double kFastest = 20;          // [m/s]
constexpr double kMostTurn = 100;        // [rad]

/// Mechanics of one finger: a mass that is pulled to its equilibrium point by a spring and a
/// damper. The spring stiffens with the force that the finger feels, like muscle.
struct Impedance {
    double mass = 0;                 ///< in addition to the mass of the device [kg]
    double stiffness = 300;          ///< [N/m]
    double damping = 3;              ///< [N*s/m]
    double stiffness_per_force = 0;  ///< relative increase in stiffness per newton of felt force
                                     ///< [1/m]
    double turn_stiffness = 1;   ///< rotational, on a handle; similar to that of a wrist [N*m/rad]
    double turn_damping = 0.02;  ///< rotational; critical for the inertia of a stylus [N*m*s/rad]
    Place place{};               ///< position in the file, as in the structs below

    template <class Visitor>
    void visit(Visitor& v) {
        v("mass", mass,
          Field::of(Quantity::mass)
              .within(0, 100)
              .says("Mass of the hand at each finger, added to that of the device."));
        v("stiffness", stiffness,
          Field::of(Quantity::stiffness)
              .within(1e-3, 1e5)
              .says("Stiffness of the spring to each finger's target."));
        v("damping", damping,
          Field::of(Quantity::damping).within(0, 1e4).says("Damping of each finger."));
        v("stiffness_per_force", stiffness_per_force,
          Field::of(Quantity::stiffness_per_force)
              .within(0, 1e5)
              .says("Rise of the stiffness with the force that the finger feels, as a "
                    "fraction of the stiffness per newton."));
        v("turn_stiffness", turn_stiffness,
          Field::of(Quantity::turn_stiffness)
              .within(1e-4, 1000)
              .says("Rotational stiffness on a handle."));
        v("turn_damping", turn_damping,
          Field::of(Quantity::turn_damping).within(0, 10).says("Rotational damping on a handle."));
    }
};

/// Physiological tremor of the equilibrium point: one sine per axis. The amplitude is the same for
/// all axes; the frequency (from the band) and the phase are drawn at random for each axis.
struct TremorSpec {
    double amplitude = 0;  ///< along each axis [m]
    double low = 8;        ///< band [Hz]
    double high = 10;

    template <class Visitor>
    void visit(Visitor& v) {
        v("amplitude", amplitude,
          Field::length().within(0, 0.1).says("Amplitude of the tremor along each axis."));
        v("low", low,
          Field::of(Quantity::frequency)
              .positive()
              .at_most(500)
              .says("Lowest frequency of the tremor."));
        v("high", high,
          Field::of(Quantity::frequency)
              .positive()
              .at_most(500)
              .says("Highest frequency of the tremor."));
    }
};

/// Position of a finger in the hand: which side of the hand's centre it is on, and its offset.
struct FingerPlace {
    std::string name;
    Vec3 side = Vec3::Zero();    ///< unit direction from the centre; zero if the finger is the
                                 ///< centre
    Vec3 offset = Vec3::Zero();  ///< added to the position, in world axes; turns with the hand [m]
    Place place{};
    std::optional<Vec3>
        centre{};  ///< initial centre of another hand to which the finger belongs [m]
    std::optional<double> aperture{};  ///< initial aperture of the other hand [m]

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, Field::text().required().says("Finger of the scene."));
        v("side", side,
          Field::number()
              .within(-kFarthest, kFarthest)
              .says("Direction from the hand's centre to the finger; zero for a finger at the "
                    "centre."));
        v("offset", offset,
          Field::length()
              .within(-kFarthest, kFarthest)
              .says("Additional displacement, which turns with the hand."));
        v("centre", centre,
          Field::length()
              .within(-kFarthest, kFarthest)
              .says("Initial centre of another hand, to which the finger belongs."));
        v("aperture", aperture,
          Field::length().within(0, kFarthest).says("Initial aperture of the other hand."));
    }
};

/// One step of a script: fingers move along minimum-jerk trajectories from where the last step
/// ended.
struct ScriptStep {
    std::string name;
    double duration = 0;             ///< [s]
    std::optional<double> aperture;  ///< at the end of the step: twice each finger's distance from
                                     ///< the centre [m]
    Vec3 move = Vec3::Zero();        ///< displacement of the centre [m]
    bool steady = false;             ///< constant speed instead of minimum jerk
    Vec3 turn = Vec3::Zero();  ///< rotation of the hand about its centre, with its handles: world
                               ///< axis times angle [rad]
    Vec3 end_velocity = Vec3::Zero();    ///< velocity of the centre; the next step starts with it
                                         ///< [m/s]
    std::vector<std::string> fingers{};  ///< fingers that move; all of them if empty
    Place place{};

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name,
          Field::text().required().says("Name of the step, and of its phase in recordings."));
        v("duration", duration,
          Field::of(Quantity::time)
              .positive()
              .at_most(kLongestScript)
              .required()
              .says("Duration of the step."));
        v("aperture", aperture,
          Field::length()
              .within(0, kFarthest)
              .says("Aperture at the step's end: twice each finger's distance from the centre; if "
                    "left out, unchanged."));
        v("move", move,
          Field::length().within(-kFarthest, kFarthest).says("Displacement of the centre."));
        v("steady", steady, says("Whether the step has constant speed, in place of minimum jerk."));
        v("turn", turn,
          Field::of(Quantity::angle)
              .within(-kMostTurn, kMostTurn)
              .says(
                  "Rotation of the hand about its centre, with its handles: a world axis times the "
                  "angle."));
        v("end_velocity", end_velocity,
          Field::of(Quantity::speed)
              .within(-kFastest, kFastest)
              .says("Velocity of the centre at the step's end, with which the next step starts."));
        v("fingers", fingers, says("Fingers that take part; if left out, all."));
    }
};

struct HandSpec {
    Impedance impedance;
    TremorSpec tremor;
    Vec3 centre = Vec3::Zero();        ///< centre of the hand at the start [m]
    double aperture = 0.1;             ///< aperture of the hand at the start [m]
    std::vector<FingerPlace> fingers;  ///< if empty: thumb at -x and index finger at +x
    std::vector<ScriptStep> script;
    Place place{};

    template <class Visitor>
    void visit(Visitor& v) {
        v("impedance", impedance, says("Mechanics of each finger."));
        v("tremor", tremor, says("Tremor of each finger's target."));
        v("centre", centre,
          Field::length().within(-kFarthest, kFarthest).says("Centre of the hand at the start."));
        v("aperture", aperture,
          Field::length()
              .within(0, kFarthest)
              .says("Twice each finger's distance from the centre at the start."));
        v("fingers", fingers,
          says("Positions of the fingers in the hand; if left out, the thumb is on the "
               "-x side and the index on the +x side."));
        v("script", script, says("Steps of the hand, one after the other."));
    }
};

}  // namespace dihaptic::hand
