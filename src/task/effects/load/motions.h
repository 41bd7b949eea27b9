// Stores the motion of bodies and handles during the last few ticks, for loads with a delay.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "frame/frame.h"
#include "frame/handle.h"

namespace dihaptic::task {

struct Motion {
    Vec3 p_W = Vec3::Zero();  ///< position of the handle, or of the body's origin [m]
    Vec3 v_W = Vec3::Zero();  ///< velocity of the handle or of the body's origin [m/s]
};

/// Things are numbered as bodies are in the Frame: the scene's bodies, then the fingers' handles.
/// Motions does not allocate after construction.
class Motions {
  public:
    /// `longest` is the longest delay of any load [s].
    Motions(size_t bodies, size_t fingers, double longest, double tick)
        : bodies_(bodies),
          tick_(tick),
          rows_(static_cast<size_t>(ticks(longest)) + 1, std::vector<Motion>(bodies + fingers)),
          known_(bodies + fingers, 0) {}

    /// Starts a tick: stores the motion of the handles in this tick and of the bodies at the end of
    /// the previous tick.
    void add(const frame::Frame& last, std::span<const frame::Handle> handles) noexcept {
        now_ = (now_ + 1) % rows_.size();
        for (size_t i = 0; i < bodies_ && last.sequence >= 0; ++i)
            set(i, {last.bodies[i].X_WB.p, last.bodies[i].v_WB});
        for (size_t i = 0; i < handles.size(); ++i)
            set(bodies_ + i, {handles[i].p_WH, handles[i].v_WH});
    }
    /// Places the body at rest at p_W in this tick, and discards its earlier motion.
    void put(int body, const Vec3& p_W) noexcept {
        known_[static_cast<size_t>(body)] = 0;
        set(static_cast<size_t>(body), {p_W, Vec3::Zero()});
    }
    void forget() noexcept { std::fill(known_.begin(), known_.end(), 0); }

    /// Motion of the thing `delay` [s] ago, or its oldest known motion if that is more recent. Null
    /// if no motion is known.
    const Motion* of(int thing, double delay) const noexcept {
        const auto i = static_cast<size_t>(thing);
        if (known_[i] == 0) return nullptr;
        const size_t back = std::min(static_cast<size_t>(ticks(delay)), known_[i] - 1);
        return &rows_[(now_ + rows_.size() - back) % rows_.size()][i];
    }

  private:
    long ticks(double time) const noexcept { return std::lround(time / tick_); }
    void set(size_t thing, const Motion& motion) noexcept {
        rows_[now_][thing] = motion;
        known_[thing] = std::min(known_[thing] + 1, rows_.size());
    }

    size_t bodies_;
    double tick_;
    std::vector<std::vector<Motion>> rows_;  // ring buffer of rows
    std::vector<size_t> known_;              // number of valid rows for each thing
    size_t now_ = 0;                         // index of the row for the current tick
};

}  // namespace dihaptic::task
