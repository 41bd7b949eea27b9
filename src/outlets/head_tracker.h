// HeadTracker provides the head position of a person in front of a screen. The laboratory's tracker
// sends this position as a Lab Streaming Layer stream. Objects in the picture can then keep their
// positions in the world as the head moves. The stream is received by a separate thread; it may
// appear late, disappear and return.
//
// The tracker gives the pose of a body T, worn by the person, in the tracker's frame S; the rig
// file gives the pose of S in the world W and the position of the eyes in T:
//
//     p_WE = X_WS X_ST p_TE        a_W = R_WS R_ST a_T
//
// where E is the midpoint between the eyes and a is the direction from the left to the right eye.
#pragma once

#include <array>
#include <atomic>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "base/field_reader.h"
#include "base/geometry.h"
#include "base/latest.h"

namespace dihaptic::outlets {

namespace lsl {
class Inlet;
}

/// Unit of the positions in a stream.
enum class StreamUnit { m, cm, mm };
constexpr auto enum_names(StreamUnit) {
    return std::array{"m", "cm", "mm"};
}

/// What follows the position in a sample: a quaternion, with its real part first or last, or
/// nothing.
enum class StreamRotation { wxyz, xyzw, none };
constexpr auto enum_names(StreamRotation) {
    return std::array{"wxyz", "xyzw", "none"};
}

/// A tracked head, as described in the rig file.
struct TrackedHead {
    std::string stream;  ///< name of the stream
    int first = 0;       ///< channel of x, counted from 0; y, z and the quaternion follow
    StreamUnit unit = StreamUnit::m;
    StreamRotation quaternion = StreamRotation::wxyz;
    Vec3 position = Vec3::Zero();  ///< origin of the tracker's frame S, in W [m]
    Vec3 rotation = Vec3::Zero();  ///< rotation of S about W's axes x, then y, then z [rad]
    Vec3 eyes = Vec3::Zero();      ///< p_TE [m]
    Vec3 along = Vec3::UnitX();    ///< the vector a_T, of any length
    std::string library;           ///< path of liblsl; if empty, the system finds it
    Place place{};

    template <class Visitor>
    void visit(Visitor& v) {
        v("stream", stream,
          Field::text().required().says("Name of the Lab Streaming Layer's stream."));
        v("first", first,
          Field::number().within(0, 1000).says("Channel of the stream, counted from 0, with x of "
                                               "the tracked body; y and z follow."));
        v("unit", unit, says("Unit of the stream's positions."));
        v("quaternion", quaternion,
          says("Data after the position: the body's rotation as a quaternion, its real part "
               "first or last, or none."));
        v("position", position,
          Field::length().within(-100, 100).says("Origin of the tracker's frame."));
        v("rotation", rotation,
          Field::of(Quantity::angle)
              .within(-100, 100)
              .says("Rotation of the tracker's frame about the world's axes x, then y, then z."));
        v("eyes", eyes,
          Field::length().within(-1, 1).says(
              "Midpoint between the eyes, in the frame of the tracked body; without a "
              "quaternion this frame is oriented like the tracker's."));
        v("along", along,
          Field::number().within(-1e6, 1e6).says(
              "Direction from the left to the right eye in that frame, of any length."));
        v("library", library,
          Field::text().says("Path of liblsl, if it is not found automatically."));
    }
};

/// Position of the eyes in the world.
struct HeadPose {
    Vec3 eyes = Vec3::Zero();    ///< midpoint between the eyes [m]
    Vec3 along = Vec3::UnitX();  ///< unit vector from the left to the right eye
    Quat R_WT = Quat::Identity();
    bool seen = false;  ///< whether the tracker sees the head; if not, this is the last known pose
};

class HeadTracker {
  public:
    /// Starts looking for the stream.
    explicit HeadTracker(const TrackedHead& head);
    ~HeadTracker();
    HeadTracker(const HeadTracker&) = delete;
    HeadTracker& operator=(const HeadTracker&) = delete;

    /// Returns the newest pose, or nullopt before the first one. Must be called from only one
    /// thread.
    std::optional<HeadPose> newest();

    struct Told {
        std::string what;
        bool problem = false;
    };
    /// Returns the events since the last call: the stream was found, or the head is no longer seen.
    std::vector<Told> take_told();

    /// After this time without a sample, the head counts as not seen [s].
    static constexpr double kSilence = 0.5;

  private:
    void run();
    void receive();
    /// Receives samples until the stream is lost, then throws Error.
    void follow(lsl::Inlet& inlet);
    /// Notes that the head is no longer seen; returns whether it was seen until now.
    bool lose();
    void tell(std::string what, bool problem);

    TrackedHead head_;
    std::optional<HeadPose> last_;  // used only by the thread
    Latest<std::optional<HeadPose>> newest_;
    std::mutex guard_;
    std::vector<Told> told_;
    std::atomic<bool> done_{false};
    std::thread thread_;
};

/// Returns the head pose in a sample; `values` starts at the head's first channel. Returns nullopt
/// if the sample has no pose: when a tracker does not see the body, it sends values that are not
/// numbers or not a rotation.
std::optional<HeadPose> head_pose(const TrackedHead& head, std::span<const float> values);

}  // namespace dihaptic::outlets
