// The state of a simulated person's reach.
#pragma once

#include "base/geometry.h"
#include "person/strain.h"

namespace dihaptic::person {

/// How noise makes the first stroke of a reach stray aside.
struct Stray {
    Vec3 whole = Vec3::Zero();  ///< deviation of the whole stroke from its direction [m]
    /// By how much it has strayed, how much of that the hand has followed, and their rates.
    Vec3 so_far = Vec3::Zero();          ///< [m]
    Vec3 rate = Vec3::Zero();            ///< [m/s]
    Vec3 followed = Vec3::Zero();        ///< [m]
    Vec3 following = Vec3::Zero();       ///< [m/s]
    Vec3 held_back = Vec3::Zero();       ///< difference made by what holds the hand [m]
    Vec3 held_back_rate = Vec3::Zero();  ///< [m/s]
};

/// The pushes that are expected and felt in a reach.
struct Pushes {
    Vec3 expected = Vec3::Zero();  ///< push expected, per speed along the reach [N*s/m]
    Vec3 opposed = Vec3::Zero();   ///< force that opposes a push, per speed along it [N*s/m]
    double lag = 0;                ///< time by which a push is expected to follow the speed [s]
    Vec3 impulse = Vec3::Zero();   ///< sum of push times speed [N*m/s]
    double moved = 0;              ///< sum of squared speed [m^2/s^2]; 0 if nothing pushed
    // sums over the ticks, from which it is learned how much later the push came
    Vec3 sum = Vec3::Zero();    ///< of the push [N]
    Vec3 timed = Vec3::Zero();  ///< of the push times its time [N*s]
    double speeds = 0;          ///< of the speed [m/s]
    double timed_speeds = 0;    ///< of the speed times its time [m]
    int ticks = 0;

    void add(const Strain& felt) noexcept {
        impulse += felt.speed * felt.push_W;
        moved += felt.speed * felt.speed;
        sum += felt.push_W;
        timed += felt.time * felt.push_W;
        speeds += felt.speed;
        timed_speeds += felt.time * felt.speed;
        ++ticks;
    }
};

struct Reach {
    bool going = false;
    bool mended = false;             ///< whether the reach was corrected on the way
    bool seen = false;               ///< whether its direction error was seen
    bool ended = false;              ///< whether its first stroke has ended and was judged
    bool pushed = false;             ///< whether a push was felt before its error was judged
    bool hidden = false;             ///< whether it began without a cursor
    int number = 0;                  ///< from 1
    size_t state = 0;                ///< index of the state in which it began
    double shows = 1;                ///< share of learned rotations that it shows
    double begin = 0;                ///< start time of its first stroke [s]
    double duration = 0;             ///< duration of its first stroke [s]; 0 if not started
    Vec3 from = Vec3::Zero();        ///< displayed position of the hand at the start [m]
    Vec3 felt_from = Vec3::Zero();   ///< felt position of the hand at the start [m]
    Vec3 goal = Vec3::Zero();        ///< where the target was seen [m]
    Vec3 way = Vec3::Zero();         ///< displacement that the display should show [m]
    Vec3 along = Vec3::Zero();       ///< unit vector of the intended direction
    Vec3 error = Vec3::Zero();       ///< rotation vector from `way` to the hand's direction [rad]
    Vec3 cursor_off = Vec3::Zero();  ///< jump of the cursor that is not answered yet [m]
    double jumped_at = 0;            ///< last time without such a jump, or one of the target [s]
    int jumps = 0;                   ///< number of jumps of the display that were answered
    Stray stray{};
    Pushes pushes{};
};

}  // namespace dihaptic::person
