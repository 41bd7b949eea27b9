// Reads the chunks of a log in the order in which they were written, even if the file has been
// damaged since: it may contain corrupted bytes, and chunks may be foreign, duplicated, missing or
// out of place.
//
// The file is read from its beginning for as long as each chunk is the expected one. At the first
// unexpected chunk, the rest of the file is searched once for chunks, which are then read in order
// of their numbers. Logs of version 1, whose chunks have no numbers, are read in file order.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/regular_file.h"
#include "recording/chunk.h"

namespace dihaptic::recording {

/// The position of a chunk in its file.
struct ChunkPlace {
    int64_t at = 0;
    uint32_t number = 0;
};

/// A complete chunk.
struct Chunk {
    enum class Place {
        own,        ///< the next chunk of this log
        moved,      ///< the next chunk of this log, but stored after later chunks
        doubled,    ///< a chunk with the same number was read before
        foreign,    ///< the chunk belongs to another session
        after_end,  ///< the chunk lies after the end mark
    };
    uint32_t kind = 0;
    Place place = Place::own;
    ChunkPlace in_file;
    int64_t bytes = 0;    ///< size including the header
    int64_t damaged = 0;  ///< number of bytes before the chunk that belong to no complete chunk
    int64_t missing = 0;  ///< number of chunks missing between the previous chunk and this one
    std::vector<std::byte> payload;
};

class ChunkReader {
  public:
    /// Throws Error if the file is not a log or if its head cannot be read.
    explicit ChunkReader(const std::string& file);

    const std::vector<std::byte>& head() const { return head_; }
    /// Returns the next chunk, which is valid until the next call, or null at the end.
    const Chunk* next();
    /// Fraction of the file that has been read, from 0 to 1.
    double share() const;

    /// Returns the positions of the chunks that contain frames, in order. In an intact log only the
    /// headers are read; a damaged log is read completely.
    std::vector<ChunkPlace> places() const;
    /// Makes next() continue with this chunk.
    void go_to(const ChunkPlace& place);
    /// Returns the position of the next frame chunk after `last`, or of the first frame chunk if
    /// `last` is null. The file may still be growing; the result is nullopt as long as that chunk
    /// is incomplete.
    std::optional<ChunkPlace> following(const ChunkPlace* last);

    /// Number of bytes after the last complete chunk. Valid only once the end has been reached.
    int64_t tail() const { return file_.size() - end_; }
    /// Whether the bytes after the last complete chunk are the beginning of a chunk that was not
    /// completely written; `bytes` becomes its intended size, or 0 if unknown. Valid only once the
    /// end has been reached.
    bool tail_is_unfinished(int64_t& bytes) const;

  private:
    struct Found {
        int64_t at = 0;
        int64_t end = 0;
        int64_t damaged = 0;
        uint32_t number = 0;  ///< for a foreign chunk: the number of the log's own chunk before it
        Chunk::Place place = Chunk::Place::own;
    };
    bool header_at(int64_t at, ChunkHeader& out) const;
    bool is_next(const ChunkPlace& place, ChunkHeader& out) const;
    bool read_at(int64_t at, ChunkHeader& out);
    bool find(int64_t from, Found& found, ChunkHeader& header);
    int64_t find_kind(int64_t from) const;
    const Chunk* give(const ChunkHeader& header, const Found& found);
    const Chunk* next_found();
    void look_through(const Found& first, const ChunkHeader& header);
    int64_t header_size() const;

    std::string name_;
    RegularFile file_;
    int version_ = 3;
    uint64_t session_ = 0;
    std::vector<std::byte> head_;
    int64_t first_ = 0;   // position of the first chunk after the head
    int64_t end_ = 0;     // end of the last complete chunk found so far
    int64_t wasted_ = 0;  // number of bytes that were read in vain
    uint64_t due_ = 0;    // number of the next expected chunk
    bool done_ = false;   // whether the end mark was read
    bool looked_ = false;
    std::vector<Found> found_;
    size_t next_found_ = 0;
    Chunk chunk_;
};

}  // namespace dihaptic::recording
