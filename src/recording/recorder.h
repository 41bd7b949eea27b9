// Records the servo's frames in raw.log. On the real clock, the servo pushes frames into a ring,
// and a separate thread of the recorder packs and writes them. On the virtual clock, frames are
// written directly by the calling thread.
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

/// How often a chunk is packed and handed to the operating system; a crash loses little more than
/// this interval. Once per interval, a frame contains all bodies, including unchanged ones, so that
/// the data after a damaged chunk can be read.
constexpr Time kFlushEvery = std::chrono::milliseconds(50);
/// How often the thread empties the ring.
constexpr Time kDrainEvery = std::chrono::milliseconds(5);

class Recorder {
  public:
    /// `sync` is the interval at which the log is synchronised to the disk [s]; 0 means only at the
    /// end. Synchronisation has its own thread, since a slow disk may take a long time.
    Recorder(const std::string& file, const LogHead& head, Writing writing, double sync = 0);
    ~Recorder();

    /// Records a frame. A frame with too many contacts for the buffer is dropped and counted. With
    /// a writing thread, record() neither waits nor allocates memory, and a frame is also dropped
    /// and counted if the ring is full. Without one, record() throws Error when the disk is full.
    void record(const frame::Frame& frame);
    /// Whether writing has failed. If so, the session must stop, and finish() throws the reason.
    bool failed() const noexcept { return failed_.load(std::memory_order_relaxed); }
    /// Writes the remaining frames and the end mark. If the writing thread encountered an error,
    /// throws that error.
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
    std::vector<std::byte> encoded_;   // used by the servo's thread
    std::vector<std::byte> received_;  // used by the recorder's thread
    Time last_whole_{0};
    bool whole_next_ = true;
    Ring ring_;
    std::atomic<int64_t> dropped_{0};
    std::atomic<bool> failed_{false};
    std::atomic<bool> done_{false};
    std::exception_ptr error_;
    std::exception_ptr sync_error_;
    std::thread thread_;
    std::mutex done_mutex_;  // the synchronising thread waits on this mutex
    std::condition_variable done_condition_;
    std::thread sync_thread_;
};

}  // namespace dihaptic::recording
