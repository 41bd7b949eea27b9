// Reads the chunks of a log in the order in which they were written, whatever has happened to the
// file since: it may contain damaged bytes, and chunks may be foreign, duplicated, missing or out
// of place.
//
// The file is read from its beginning as long as each chunk is the expected one. At the first
// unexpected chunk, the rest of the file is searched once, and then read in the order of the
// chunks' numbers. Logs of version 1, whose chunks have no numbers, are read in file order.
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

/// A whole chunk.
struct Chunk {
    enum class Place {
        own,        ///< the next existing chunk
        moved,      ///< the next existing chunk, but stored after later ones
        doubled,    ///< a chunk with the same number was read before
        foreign,    ///< the chunk belongs to another session
        after_end,  ///< the chunk lies after the end mark
    };
    uint32_t kind = 0;
    Place place = Place::own;
    ChunkPlace in_file;
    int64_t bytes = 0;    ///< including the header
    int64_t damaged = 0;  ///< bytes before the chunk in the file that belong to no whole chunk
    int64_t missing = 0;  ///< number of chunks missing between the previous one and this one
    std::vector<std::byte> payload;
};

class ChunkReader {
  public:
    /// Throws Error if the file is not a log, or if its head cannot be read.
    explicit ChunkReader(const std::string& file);

    const std::vector<std::byte>& head() const { return head_; }
    /// Returns the next chunk, valid until the next call; null at the end.
    const Chunk* next();
    /// Share of the file that has been read, from 0 to 1.
    double share() const;

    /// Positions of the chunks with frames, in order. Of an intact log, only the headers are read;
    /// a damaged log is read completely.
    std::vector<ChunkPlace> places() const;
    /// Makes next() continue with this chunk.
    void go_to(const ChunkPlace& place);
    /// The position of the chunk with frames that follows `last` (null: the first one), in a file
    /// that may still be growing; nullopt as long as the chunk is incomplete.
    std::optional<ChunkPlace> following(const ChunkPlace* last);

    /// After the end: number of bytes after the last whole chunk.
    int64_t tail() const { return file_.size() - end_; }
    /// After the end: whether these bytes begin an incompletely written chunk; `bytes` is its
    /// intended size, 0 if unknown.
    bool tail_is_unfinished(int64_t& bytes) const;

  private:
    struct Found {
        int64_t at = 0;
        int64_t end = 0;
        int64_t damaged = 0;
        uint32_t number = 0;  ///< of a foreign chunk: the number of the own chunk before it
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
    int64_t end_ = 0;     // end of the last whole chunk in the file so far
    int64_t wasted_ = 0;  // bytes that were read in vain
    uint64_t due_ = 0;    // number of the chunk that comes next
    bool done_ = false;   // the end mark was read
    bool looked_ = false;
    std::vector<Found> found_;
    size_t next_found_ = 0;
    Chunk chunk_;
};

}  // namespace dihaptic::recording
