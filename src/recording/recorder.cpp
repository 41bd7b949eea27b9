#include "recording/recorder.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::recording {
namespace {

/// Largest number of contacts that a recorded frame may have; it determines the size of the frame's
/// buffer.
size_t most_contacts(const LogHead& head) {
    return 64 + 8 * (head.fingers.size() + head.bodies.size());
}

/// Capacity of the ring: one second of frames, to bridge times when the disk is busy.
size_t ring_frames(const LogHead& head) {
    return static_cast<size_t>(std::ceil(1 / head.tick));
}
constexpr size_t kMostRing = 64u << 20;

}  // namespace

Recorder::Recorder(const std::string& file, const LogHead& head, Writing writing, double sync)
    : log_(file, head),
      writing_(writing),
      encoded_(most_bytes(head.layout(), most_contacts(head))),
      ring_(writing == Writing::in_place
                ? 0
                : std::min(kMostRing, ring_frames(head) * encoded_.size())) {
    if (writing_ == Writing::in_thread) thread_ = std::thread([this] { run(); });
    if (sync > 0) {
        sync_thread_ =
            std::thread([this, sync] { keep_synced(std::chrono::duration<double>(sync)); });
    }
}

Recorder::~Recorder() {
    join();
}

void Recorder::join() {
    {
        const std::lock_guard lock(done_mutex_);
        done_.store(true);
    }
    done_condition_.notify_all();
    if (thread_.joinable()) thread_.join();
    if (sync_thread_.joinable()) sync_thread_.join();
}

void Recorder::record(const frame::Frame& frame) {
    const bool whole = whole_next_ || frame.time - last_whole_ >= kFlushEvery;
    const size_t size = encode(frame, encoded_, whole ? Bodies::all : Bodies::changed);
    const std::span<const std::byte> bytes(encoded_.data(), size);
    bool taken = size > 0;
    if (taken && writing_ == Writing::in_thread) {
        taken = ring_.push(bytes);
    } else if (taken) {
        if (whole) log_.flush();
        log_.add(bytes);
    }
    if (!taken) dropped_.fetch_add(1, std::memory_order_relaxed);
    whole_next_ = !taken;  // the next frame must be complete if this one was lost
    if (whole) last_whole_ = frame.time;
}

void Recorder::drain() {
    while (ring_.pop(received_)) log_.add(received_);
}

void Recorder::run() {
    using Wall = std::chrono::steady_clock;
    try {
        Wall::time_point flushed = Wall::now();
        while (!done_.load()) {
            drain();
            if (Wall::now() - flushed >= kFlushEvery) {
                log_.flush();
                flushed = Wall::now();
            }
            std::this_thread::sleep_for(kDrainEvery);
        }
        drain();
        log_.flush();
    } catch (...) {
        error_ = std::current_exception();
        failed_.store(true);
    }
}

void Recorder::keep_synced(std::chrono::duration<double> every) {
    try {
        std::unique_lock lock(done_mutex_);
        while (!done_condition_.wait_for(lock, every, [this] { return done_.load(); })) {
            lock.unlock();
            log_.sync();
            lock.lock();
        }
    } catch (...) {
        sync_error_ = std::current_exception();
        failed_.store(true);
    }
}

void Recorder::finish() {
    join();
    if (error_) std::rethrow_exception(error_);
    if (sync_error_) std::rethrow_exception(sync_error_);
    log_.finish();
}

}  // namespace dihaptic::recording
