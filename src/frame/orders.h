// The input and the output of a tick: the orders of the director, and the sink that receives the
// Frames.
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
    Knobs knobs;  ///< initially the knobs of the settings
};

/// Orders for a single tick. There are no orders when the director is called.
struct TickOrders {
    bool stop = false;       ///< whether this tick is the last
    bool force_off = false;  ///< whether the operator has switched force off, from this tick on
    bool rest = false;  ///< whether to pause: there is no force in this tick, which is the last one
                        ///< until resume()
    /// Time for which the window that watches the session has not responded, if this time is too
    /// long; otherwise 0 [s]. If nonzero, force is off from this tick on.
    double abandoned = 0;
    TaskFrame task;

    /// Removes all orders, but keeps the memory.
    void clear() noexcept {
        TaskFrame memory = std::move(task);
        memory.clear();
        *this = {};
        task = std::move(memory);
    }
};

/// All orders that the director gives for a tick.
struct Commands : LastingOrders, TickOrders {};

/// Fills in the orders for the tick that is starting.
///
/// The director is called in each tick, after the devices have been read and before forces are
/// computed. It receives the Frame of the last tick and the current state of the handles.
/// `commands` holds the lasting orders as the director left them, initially those of the settings,
/// and no orders for the tick. In the first tick there is no last Frame: `last.sequence` is -1, and
/// the lists of `last` have the lengths that the scene requires, but contain no measurements. Since
/// the director runs as part of the tick, it must not allocate, lock, wait or throw.
using Director =
    std::function<void(const Frame& last, std::span<const Handle> handles, Commands& commands)>;

/// Receives each Frame at the end of its tick; the Frame is valid only until the next tick starts.
/// On the real clock, the sink is called in the servo's thread, where it must not allocate, lock,
/// wait or throw.
using FrameSink = std::function<void(const Frame&)>;

}  // namespace dihaptic::frame
