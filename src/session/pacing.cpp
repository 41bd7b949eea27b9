#include "session/pacing.h"

#include <algorithm>
#include <thread>

namespace dihaptic::session {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLook{5};      // longest sleep before the requested pace is read again
constexpr milliseconds kBehind{100};  // a delay larger than this is not made up for

}  // namespace

bool Pacing::wait_in_pause() {
    while (live_.paused && !over()) {
        if (live_.steps > 0) {
            --live_.steps;
            return true;
        }
        std::this_thread::sleep_for(kLook);
    }
    return false;
}

void Pacing::wait(Time now) {
    if (live_.paused) {
        pace_ = -1;  // after the pause, timing starts again
        if (wait_in_pause()) return;
    }
    while (!over()) {
        const double pace = live_.pace;
        if (pace <= 0) return;
        if (pace != pace_) {
            pace_ = pace;
            from_ = now;
            begun_ = Wall::now();
        }
        const auto due = begun_ + std::chrono::duration_cast<Wall::duration>((now - from_) / pace);
        const auto ahead = due - Wall::now();
        if (ahead < -kBehind) pace_ = -1;
        if (ahead <= Wall::duration(0) || live_.paused) return;
        std::this_thread::sleep_for(std::min<Wall::duration>(ahead, kLook));
    }
}

}  // namespace dihaptic::session
