// raw.log: what is written while a session runs. Append-only, in chunks that each carry a checksum,
// so that whatever was written before a crash can be read after it.
//
//   "DIHAPTIC LOG 1\n", then chunks:
//   chunk   u32 kind, u32 bytes of payload, u32 CRC-32 of kind, bytes and payload, payload
//   kinds   head: YAML (layout, tick, names, schema)     first chunk
//           data: records, each u32 length and a frame (codec.h)
//           done: i64 number of frames                   last chunk of a session that ended
//
// It holds nothing but what the session computed, so that the same session gives the same file.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#include "base/field.h"
#include "recording/codec.h"

namespace dihaptic::recording {

/// What a log is about.
struct LogHead {
    double tick = 1e-3;  ///< [s]
    std::vector<std::string> fingers;
    std::vector<std::string> bodies;  ///< of the scene

    Layout layout() const { return {fingers.size(), bodies.size()}; }
    template <class Visitor>
    void visit(Visitor& v) {
        v("tick", tick, Field::of(Quantity::time).positive().required());
        v("fingers", fingers);
        v("bodies", bodies);
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
    /// After next() gave null: the log has its end mark.
    bool complete() const { return complete_; }
    /// After next() gave null: bytes at the end that are no whole chunk.
    int64_t damaged_bytes() const { return damaged_; }

  private:
    bool read_chunk();

    std::string file_;
    std::ifstream in_;
    int64_t size_ = 0;
    LogHead head_;
    uint32_t kind_ = 0;
    std::vector<std::byte> chunk_;
    size_t at_ = 0;
    servo::Frame frame_;
    bool complete_ = false;
    int64_t damaged_ = 0;
};

}  // namespace dihaptic::recording
