// Writes and reads raw.log, the recording made while a session runs. The file is only ever appended
// to, in chunks that contain a checksum, the session's hash and the chunk's number (chunk.h).
// Therefore everything written before a crash can be read afterwards, and no other data are
// mistaken for the session's.
//
//   kinds   head: YAML (layout, tick, names, setup, schema)   first chunk
//           data: records, each u32 length and a frame (codec.h, schema.h)
//           pack: such records, packed (pack.h); the kind written today
//           done: i64 number of frames                   last chunk of a session that ended
//
// A damaged chunk is skipped: the reader continues with the next chunk. In a log written without a
// recorder thread, the first frame of each chunk contains all bodies. Body values that are unknown
// after a gap are NaN.
//
// The log contains only the session's results, so that the same session always gives the same file.
// On the real clock no two sessions are the same, and the identity stored in the head is random.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "base/descriptor.h"
#include "base/field.h"
#include "recording/chunk_reader.h"
#include "recording/codec.h"
#include "recording/decoder.h"
#include "recording/log_health.h"
#include "recording/pack.h"
#include "recording/setup.h"

namespace dihaptic::recording {

/// The description of a session that is stored in the head of its log.
struct LogHead : Setup {
    double tick = 1e-3;  ///< [s]
    std::vector<std::string> fingers;
    std::vector<std::string> bodies;  ///< bodies of the scene
    std::vector<std::string> joints;  ///< joints of the scene

    /// Returns the fingers whose devices measure orientation, in order.
    std::vector<std::string> turning_fingers() const {
        std::vector<std::string> out;
        for (const DeviceRecord& device : devices) {
            if (device.measures_orientation) out.push_back(device.finger);
        }
        return out;
    }
    Layout layout() const {
        const auto turns = std::count_if(devices.begin(), devices.end(), [](const DeviceRecord& d) {
            return d.measures_orientation;
        });
        return {fingers.size(), bodies.size(), static_cast<size_t>(turns), joints.size()};
    }
    template <class Visitor>
    void visit(Visitor& v) {
        v("tick", tick, Field::of(Quantity::time).within(1e-6, 1).required());
        v("fingers", fingers);
        v("bodies", bodies);
        v("joints", joints);
        Setup::visit(v);
    }
};

class RawLogWriter {
  public:
    /// Creates the file. Throws Error if the file exists already or cannot be written.
    RawLogWriter(const std::string& file, const LogHead& head);
    ~RawLogWriter();
    RawLogWriter(const RawLogWriter&) = delete;
    RawLogWriter& operator=(const RawLogWriter&) = delete;

    /// Adds an encoded frame to the current chunk. Throws Error if the disk is full.
    void add(std::span<const std::byte> frame);
    /// Packs the current chunk and hands it to the operating system, so that it survives a crash of
    /// this program.
    void flush();
    /// Synchronises the written data to the disk, so that they survive a power failure. May be
    /// called from any thread until finish(). Throws Error if the disk fails.
    void sync() const;
    /// Writes the end mark and synchronises the file to the disk.
    void finish();

    int64_t frames() const { return frames_; }

  private:
    void write_chunk(uint32_t kind, std::span<const std::byte> payload);

    std::string file_;
    Descriptor descriptor_;
    uint64_t session_ = 0;
    uint32_t number_ = 0;  // number of the next chunk
    Packer packer_;
    int64_t frames_ = 0;
};

class RawLogReader {
  public:
    /// Throws Error if the file is not a log or if it does not describe the contents of its frames.
    explicit RawLogReader(const std::string& file);

    const LogHead& head() const { return head_; }
    /// Returns the next frame, which is valid until the next call, or null at the end of the
    /// readable part.
    const frame::Frame* next();
    /// What has been found so far. Information about the end is valid only once next() has returned
    /// null.
    const LogHealth& health() const { return health_; }
    /// Reads the rest of the log and returns what was found.
    const LogHealth& read_to_end();
    /// Fraction of the file that has been read, from 0 to 1.
    double share() const { return chunks_.share(); }

    /// Returns the positions of the chunks that contain frames, in order.
    std::vector<ChunkPlace> places() const { return chunks_.places(); }
    /// Returns the position of the next frame chunk after `last`, or of the first frame chunk if
    /// `last` is null. The log may still be growing; the result is nullopt as long as that chunk is
    /// incomplete.
    std::optional<ChunkPlace> following(const ChunkPlace* last) { return chunks_.following(last); }
    /// Makes next() return the frames of only this chunk. `follows` states that the chunk directly
    /// follows the last one read, so that bodies keep their state; otherwise everything noted in
    /// health() is discarded.
    void go_to(const ChunkPlace& place, bool follows = false);

  private:
    void read_head();
    bool read_chunk();
    void begin_records(const Chunk& chunk);
    bool read_frame();
    void note_done(const Chunk& chunk);
    void note_end();
    void note_frame();
    void forget_bodies(bool all);
    int64_t ticks_in(int64_t bytes) const;

    std::string file_;
    ChunkReader chunks_;
    LogHead head_;
    Layout layout_;
    std::optional<FrameDecoder> decoder_;
    Unpacker unpacker_;
    std::span<const std::byte> rest_;  // remaining records of the current chunk
    bool ended_ = false;
    frame::Frame frame_;
    LogHealth health_;
    int64_t damaged_ = 0;     // number of damaged bytes since the last frame
    int64_t gone_ = 0;        // number of missing chunks since the last frame
    int64_t read_bytes_ = 0;  // size of the chunks whose frames were read
};

}  // namespace dihaptic::recording
