// Records the servo's frames in raw.log. On the real clock the servo pushes frames into a ring, and
// a thread of the recorder packs and writes them; on the virtual clock they are written in place.
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

/// A chunk is packed and passed to the operating system this often, so a crash can lose little more
/// than this interval. Once per interval, a frame contains all bodies, changed or not, so that the
/// data after a damaged chunk can be read.
constexpr Time kFlushEvery = std::chrono::milliseconds(50);
/// How often the thread empties the ring.
constexpr Time kDrainEvery = std::chrono::milliseconds(5);

class Recorder {
  public:
    /// `sync` is how often the log is synchronised to the disk [s], in a separate thread, since a
    /// slow disk may take long; 0: only at the end.
    Recorder(const std::string& file, const LogHead& head, Writing writing, double sync = 0);
    ~Recorder();

    /// Records a frame. A frame with too many contacts for the buffer is dropped and counted. With
    /// a thread, record() neither waits nor allocates, and a frame that finds the ring full is
    /// dropped and counted too; in place, it throws Error when the disk is full.
    void record(const frame::Frame& frame);
    /// True once writing has failed: the session must stop, and finish() throws the reason.
    bool failed() const noexcept { return failed_.load(std::memory_order_relaxed); }
    /// Writes the rest, and the end mark. Throws the error that the thread met, if any.
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
    std::vector<std::byte> encoded_;   // used by the servo
    std::vector<std::byte> received_;  // used by the thread
    Time last_whole_{0};
    bool whole_next_ = true;
    Ring ring_;
    std::atomic<int64_t> dropped_{0};
    std::atomic<bool> failed_{false};
    std::atomic<bool> done_{false};
    std::exception_ptr error_;
    std::exception_ptr sync_error_;
    std::thread thread_;
    std::mutex done_mutex_;  // on which the synchronising thread waits
    std::condition_variable done_condition_;
    std::thread sync_thread_;
};

}  // namespace dihaptic::recording
