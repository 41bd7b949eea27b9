// The trace of a grasp, tick by tick, and the figures derived from it. Used for session summaries
// and for benchmarks.
#pragma once

#include <boost/container/small_vector.hpp>
#include <vector>

#include "frame/frame.h"

namespace dihaptic::analysis {

/// Half-open range of samples, [first, last).
struct Range {
    size_t first = 0;
    size_t last = 0;
    size_t size() const { return last > first ? last - first : 0; }
};

/// One value per finger. Up to three values are stored without heap memory, because every tick has
/// such lists.
template <class T>
using PerFinger = boost::container::small_vector<T, 3>;

/// Stores those quantities of each Frame from which the figures are computed.
class GraspTrace {
  public:
    /// `object`: index of the body that is grasped; `tick`: time between samples [s].
    GraspTrace(int object, double tick) : object_(object), tick_(tick) {}

    void add(const frame::Frame& frame);
    /// Removes the samples but keeps the memory for the next trial.
    void restart() noexcept { samples_.clear(); }

    struct Sample {
        double time;
        int phase;
        double grip;      ///< [N]
        double load;      ///< [N]
        bool on_support;  ///< whether the object presses on a body other than a finger
        int support;      ///< body on which the object presses hardest; -1 if none
        Vec3 n_support;   ///< normal of the contact with the support, pointing into the object
        Vec3 v_sliding;   ///< velocity of the object along the support [m/s]
        bool awake;       ///< whether the object is awake
        Pose X_WB;        ///< pose of the object
        Vec3 v_WB;
        PerFinger<Vec3> p_WP;
        PerFinger<Vec3> v_WH;
        PerFinger<Vec3> f_sent_W;  ///< force sent to the handle
        double torque;             ///< largest torque on any handle [N*m]; NaN without orientation
        PerFinger<char> touching;  ///< whether the finger presses on the object
        // contact force between each finger and the object
        PerFinger<double> normal_force;  ///< [N]
        PerFinger<Vec3> f_tangential_W;  ///< tangential force on the finger [N]
        // factors on properties in the scene
        double friction_scale = 1;          ///< on the object's coefficients of friction
        double support_friction_scale = 1;  ///< on those of the support
        Vec3 mass_scale = Vec3::Ones();     ///< on the object's inertia, along each axis of W
        double weight_scale = 1;            ///< on the object's weight
        bool resumed = false;               ///< whether the session continued after a pause

        /// Whether any finger presses on the object.
        bool touched() const;
    };
    const std::vector<Sample>& samples() const { return samples_; }
    double tick() const { return tick_; }
    size_t fingers() const { return samples_.empty() ? 0 : samples_.front().p_WP.size(); }

    /// Returns the trace for a range of the samples.
    GraspTrace part(Range range) const;
    /// Returns the samples at times in [from, to) [s].
    Range between(double from, double to) const;
    Range of_phase(int phase) const;

    /// First sample in which the object presses only on fingers; samples().size() if there is no
    /// such sample.
    size_t lift_off() const;
    /// Whether every finger presses on the object in every sample.
    bool all_touching(Range range) const;
    /// Largest displacement of a proxy's origin, in the object's frame, since the start of the
    /// range [m].
    double slip(Range range) const;
    double slip(Range range, size_t finger) const;
    /// Root mean square and peak-to-peak value of the object's height about its mean [m].
    double height_rms(Range range) const;
    double height_range(Range range) const;
    /// Lowest height in the range, relative to the height at the start of the range [m].
    double sag(Range range) const;
    /// RMS angle of the grasp axis (model/grasp.h) about its mean direction [rad].
    double axis_tilt_rms(Range range) const;
    /// Largest rotation of the object about the grasp axis since the start of the range [rad].
    double turn(Range range) const;
    double turn_at(size_t reference, size_t sample) const;
    /// RMS of the force on a handle above 5 Hz (zero-phase Butterworth filter), for the finger with
    /// the largest value [N].
    double force_above_5_hz(Range range) const;
    /// Mean of the downward forces on the handles, summed over the fingers [N].
    double weight_felt(Range range) const;
    double mean_weight_scale(Range range) const { return mean(range, &Sample::weight_scale); }
    double mean_grip(Range range) const { return mean(range, &Sample::grip); }
    double mean_load(Range range) const { return mean(range, &Sample::load); }
    double peak_grip(Range range) const;
    /// Largest force sent to any handle, and the largest of the mean forces of the fingers [N].
    double peak_force(Range range) const;
    double mean_force(Range range) const;
    /// Largest torque on any handle in any sample, and the mean of the largest torques over the
    /// samples [N*m]. NaN when no device measures orientation.
    double peak_torque(Range range) const;
    double mean_torque(Range range) const;

  private:
    double mean(Range range, double Sample::*of) const;

    int object_;
    double tick_;
    std::vector<Sample> samples_;
};

}  // namespace dihaptic::analysis
