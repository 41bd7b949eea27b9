// raw.log: what is written while a session runs. Append-only, in chunks that each carry a checksum,
// so that whatever was written before a crash can be read after it.
//
//   "DIHAPTIC LOG 1\n", then chunks:
//   chunk   u32 kind, u32 bytes of payload, u32 CRC-32 of kind, bytes and payload, payload
//   kinds   head: YAML (layout, tick, names, setup, schema)   first chunk
//           data: records, each u32 length and a frame (codec.h)
//           done: i64 number of frames                   last chunk of a session that ended
//
// A damaged chunk is left out: the reader goes on at the next one, which it knows by its kind,
// spelt out, and its checksum. The first frame of a chunk that was written in place has all bodies;
// what is not known of a body after a gap is NaN.
//
// It holds nothing but what the session computed, so that the same session gives the same file.
#pragma once

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#include "base/field.h"
#include "recording/codec.h"
#include "recording/log_health.h"
#include "recording/setup.h"

namespace dihaptic::recording {

/// What a log is about.
struct LogHead : Setup {
    double tick = 1e-3;  ///< [s]
    std::vector<std::string> fingers;
    std::vector<std::string> bodies;  ///< of the scene

    /// Fingers whose devices measure orientation, in order.
    std::vector<std::string> turning_fingers() const {
        std::vector<std::string> out;
        for (const DeviceRecord& device : devices) {
            if (device.orientation) out.push_back(device.finger);
        }
        return out;
    }
    Layout layout() const {
        const auto turns = std::count_if(devices.begin(), devices.end(),
                                         [](const DeviceRecord& d) { return d.orientation; });
        return {fingers.size(), bodies.size(), static_cast<size_t>(turns)};
    }
    template <class Visitor>
    void visit(Visitor& v) {
        v("tick", tick, Field::of(Quantity::time).positive().required());
        v("fingers", fingers);
        v("bodies", bodies);
        Setup::visit(v);
    }
};

class RawLogWriter {
  public:
    /// Creates the file. Throws Error when it exists or cannot be written.
    RawLogWriter(const std::string& file, const LogHead& head);
    ~RawLogWriter();
    RawLogWriter(const RawLogWriter&) = delete;
    RawLogWriter& operator=(const RawLogWriter&) = delete;

    /// Adds an encoded frame to the chunk that is being filled. Throws Error when the disk is full.
    void add(std::span<const std::byte> frame);
    /// Hands the chunk to the operating system: from here on it survives the end of this program.
    void flush();
    /// Writes the mark of a session that ended, and syncs the disk.
    void finish();

    int64_t frames() const { return frames_; }

  private:
    void write_chunk(uint32_t kind, std::span<const std::byte> payload);

    std::string file_;
    int descriptor_ = -1;
    std::vector<std::byte> chunk_;
    int64_t frames_ = 0;
};

class RawLogReader {
  public:
    /// Throws Error when the file is no log, or one of another version.
    explicit RawLogReader(const std::string& file);

    const LogHead& head() const { return head_; }
    /// The next frame, valid until the next call; null at the end of what can be read.
    const servo::Frame* next();
    /// What was found so far; the end is known after next() gave null.
    const LogHealth& health() const { return health_; }
    /// Share of the file that was read.
    double share() const { return static_cast<double>(end_) / static_cast<double>(size_); }

  private:
    bool read_chunk();
    bool read_chunk_at(int64_t at);
    int64_t find_kind(int64_t from);
    void note_frame();
    void note_tail(int64_t bytes);
    void note_unfinished_chunk();
    int64_t ticks_in(int64_t bytes) const;

    std::string file_;
    std::ifstream in_;
    int64_t size_ = 0;
    int64_t end_ = 0;      // of the last whole chunk
    int64_t skipped_ = 0;  // bytes between it and the one before
    LogHead head_;
    uint32_t kind_ = 0;
    std::vector<std::byte> chunk_;
    size_t at_ = 0;
    servo::Frame frame_;
    LogHealth health_;
    int64_t frame_bytes_ = 0;  // of all frames read
    bool ended_ = false;
};

}  // namespace dihaptic::recording
