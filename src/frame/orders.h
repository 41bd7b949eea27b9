// The input and the output of a tick: the director's orders, and the sink of Frames.
#pragma once

#include <functional>
#include <span>
#include <utility>

#include "frame/frame.h"
#include "frame/handle.h"

namespace dihaptic::frame {

/// Orders that remain in effect until the director changes them.
struct LastingOrders {
    int32_t trial = 0;
    int32_t phase = 0;
    Knobs knobs;  ///< initially those of the settings
};

/// Orders for one tick: empty before the director is called.
struct TickOrders {
    bool stop = false;       ///< whether this tick is the last
    bool force_off = false;  ///< from this tick on, permanently, at the operator's request
    bool rest = false;       ///< a pause: no force in this tick, which is the last until resume()
    /// Time for which the window that watches the session has not answered, if it is too long;
    /// otherwise 0 [s]. If it is set, force is off from this tick on.
    double abandoned = 0;
    TaskFrame task;

    /// Resets to no orders; keeps the memory.
    void clear() noexcept {
        TaskFrame memory = std::move(task);
        memory.clear();
        *this = {};
        task = std::move(memory);
    }
};

/// The director's orders for a tick.
struct Commands : LastingOrders, TickOrders {};

/// Fills in the orders for the starting tick.
///
/// It is called in each tick once the devices have been read, before forces are computed: with the
/// Frame of the last tick, and the present handles. `commands` holds the lasting
/// orders as the director left them, initially those of the settings, and no orders for the tick.
/// In the first tick there is no last Frame: `last.sequence` is -1, and the lists of `last` are as
/// long as the scene's, without measurements. As a part of the tick the director must not
/// allocate, lock, wait or throw.
using Director =
    std::function<void(const Frame& last, std::span<const Handle> handles, Commands& commands)>;

/// Receives each Frame at the end of its tick; the Frame is valid until the next. On the real clock
/// it is called in the servo's thread, where it must not allocate, lock, wait or throw.
using FrameSink = std::function<void(const Frame&)>;

}  // namespace dihaptic::frame
