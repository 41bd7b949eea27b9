// From the servo's frames to raw.log. On the real clock the servo pushes into a ring and a thread
// of the recorder's writes; on the virtual clock frames are written where they arise.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "base/ring.h"
#include "recording/raw_log.h"

namespace dihaptic::recording {

enum class Writing { in_place, in_thread };

/// A chunk is packed and handed to the operating system this often: little more than that a crash
/// can lose. As often a frame has all bodies, whether they changed or not: what follows a damaged
/// chunk can be read.
constexpr Time kFlushEvery = std::chrono::milliseconds(50);
/// How often the thread empties the ring.
constexpr Time kDrainEvery = std::chrono::milliseconds(5);

class Recorder {
  public:
    /// `sync`: how often what was written is synchronised to the disk, in a thread of its own,
    /// which a slow disk may keep waiting [s]; 0: at the end alone.
    Recorder(const std::string& file, const LogHead& head, Writing writing, double sync = 0);
    ~Recorder();

    /// Records a frame; one with more contacts than there is room for is dropped and counted. In a
    /// thread: neither waits nor allocates; a frame that finds the ring full is dropped and counted
    /// too. In place: throws Error when the disk is full.
    void record(const servo::Frame& frame);
    /// True once writing has failed: stop the session, then finish() says why.
    bool failed() const noexcept { return failed_.load(std::memory_order_relaxed); }
    /// Writes what is left, and the end mark. Throws what the thread met.
    void finish();

    int64_t frames() const { return log_.frames(); }
    int64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

  private:
    void drain();
    void run();
    void keep_synced(std::chrono::duration<double> every);
    void join();

    RawLogWriter log_;
    Writing writing_;
    std::vector<std::byte> encoded_;   // servo's side
    std::vector<std::byte> received_;  // thread's side
    Time last_whole_{0};
    bool whole_next_ = true;
    Ring ring_;
    std::atomic<int64_t> dropped_{0};
    std::atomic<bool> failed_{false};
    std::atomic<bool> done_{false};
    std::exception_ptr error_;
    std::exception_ptr sync_error_;
    std::thread thread_;
    std::mutex done_mutex_;  // for the wait of the thread that synchronises
    std::condition_variable done_condition_;
    std::thread sync_thread_;
};

}  // namespace dihaptic::recording
