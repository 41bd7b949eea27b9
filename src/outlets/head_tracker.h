// HeadTracker gives the position of the head of a person before a screen, which a tracker of the
// laboratory sends as a stream of the Lab Streaming Layer. Things in the picture can then stay
// where they are in the world as the head moves. A thread of its own receives the stream, which may
// appear late, disappear and return.
//
// The tracker gives the pose of a body T, which the person wears, in its own frame S; the rig file
// gives the pose of S in the world W and the place of the eyes in T:
//
//     p_WE = X_WS X_ST p_TE        a_W = R_WS R_ST a_T
//
// with E the middle between the eyes, and a the direction from the left eye to the right one.
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

/// Unit of a stream's positions.
enum class StreamUnit { m, cm, mm };
constexpr auto enum_names(StreamUnit) {
    return std::array{"m", "cm", "mm"};
}

/// What follows the position in a sample: a quaternion, its real part first or last, or nothing.
enum class StreamRotation { wxyz, xyzw, none };
constexpr auto enum_names(StreamRotation) {
    return std::array{"wxyz", "xyzw", "none"};
}

/// A tracked head, as the rig file describes it.
struct TrackedHead {
    std::string stream;  ///< its name
    int first = 0;       ///< channel, from 0, that is x; y, z and the quaternion follow
    StreamUnit unit = StreamUnit::m;
    StreamRotation quaternion = StreamRotation::wxyz;
    Vec3 position = Vec3::Zero();  ///< of the tracker's frame S, in W [m]
    Vec3 rotation = Vec3::Zero();  ///< of S about the world's axes x, then y, then z [rad]
    Vec3 eyes = Vec3::Zero();      ///< p_TE [m]
    Vec3 along = Vec3::UnitX();    ///< a_T, of any length
    std::string library;           ///< path of liblsl; empty: where the system finds it
    Place place{};

    template <class Visitor>
    void visit(Visitor& v) {
        v("stream", stream,
          Field::text().required().says("Name of the Lab Streaming Layer's stream."));
        v("first", first,
          Field::number().within(0, 1000).says(
              "Channel of it, counted from 0, that is x of the tracked body; y and z follow."));
        v("unit", unit, says("Unit of the stream's positions."));
        v("quaternion", quaternion,
          says("What follows the position: the body's rotation as a quaternion, its real part "
               "first or last, or none."));
        v("position", position,
          Field::length().within(-100, 100).says("Where the origin of the tracker's frame is."));
        v("rotation", rotation,
          Field::of(Quantity::angle)
              .within(-100, 100)
              .says("The frame's rotation about the world's axes x, then y, then z."));
        v("eyes", eyes,
          Field::length().within(-1, 1).says(
              "The middle between both eyes, in the frame of the tracked body, which without a "
              "quaternion is turned as the tracker's."));
        v("along", along,
          Field::number().within(-1e6, 1e6).says(
              "Direction from the left eye to the right one in that frame, of any length."));
        v("library", library,
          Field::text().says("Path of liblsl, if it is not found automatically."));
        if constexpr (requires { v.place(); }) place = v.place();
    }
};

/// Where eyes are, in the world.
struct HeadPose {
    Vec3 eyes = Vec3::Zero();    ///< the middle between them [m]
    Vec3 along = Vec3::UnitX();  ///< from the left one to the right one, of length 1
    Quat R_WT = Quat::Identity();
    bool seen = false;  ///< the tracker sees the head; otherwise it is where it was seen last
};

class HeadTracker {
  public:
    /// Begins to look for the stream.
    explicit HeadTracker(const TrackedHead& head);
    ~HeadTracker();
    HeadTracker(const HeadTracker&) = delete;
    HeadTracker& operator=(const HeadTracker&) = delete;

    /// From one thread: the newest pose; nullopt until there is one.
    std::optional<HeadPose> newest();

    struct Told {
        std::string what;
        bool problem = false;
    };
    /// What has happened since the last call: the stream was found, or the head is not seen.
    std::vector<Told> take_told();

    /// A head counts as not seen after this time without a sample [s].
    static constexpr double kSilence = 0.5;

  private:
    void run();
    void receive();
    /// Takes samples until the stream is lost; it then throws Error.
    void follow(lsl::Inlet& inlet);
    /// Notes that the head is no longer seen; returns whether it was seen before.
    bool lose();
    void tell(std::string what, bool problem);

    TrackedHead head_;
    std::optional<HeadPose> last_;  // the thread's own
    Latest<std::optional<HeadPose>> newest_;
    std::mutex guard_;
    std::vector<Told> told_;
    std::atomic<bool> done_{false};
    std::thread thread_;
};

/// The pose in a sample; `values` begin at the head's first channel. nullopt if there is none: a
/// tracker that does not see the body sends something that is not a number, or not a rotation.
std::optional<HeadPose> head_pose(const TrackedHead& head, std::span<const float> values);

}  // namespace dihaptic::outlets
