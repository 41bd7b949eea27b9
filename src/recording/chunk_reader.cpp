#include "recording/chunk_reader.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "base/diagnostics.h"

namespace dihaptic::recording {
namespace {

/// The file is searched for chunks in blocks of this many bytes.
constexpr int64_t kBlock = 1 << 16;
/// Bytes that only look like a chunk may have to be read repeatedly, once from each place where a
/// chunk seems to start. If a file requires more repeated reading than this, it must have been
/// crafted to keep its reader busy [bytes].
constexpr int64_t kMostWasted = int64_t{1} << 30;
constexpr std::array kKinds{kHead, kData, kPacked, kDone};

bool has_frames(uint32_t kind) {
    return kind == kData || kind == kPacked;
}

}  // namespace

ChunkReader::ChunkReader(const std::string& file) : name_(file), file_(file) {
    std::array<std::byte, kFirstLine.size()> line{};
    const size_t size = file_.read(0, line);
    const std::string_view first(reinterpret_cast<const char*>(line.data()), size);
    const std::array lines{kFirstLine1, kFirstLine2, kFirstLine};
    const auto line_of = std::find(lines.begin(), lines.end(), first);
    if (line_of == lines.end()) {
        throw Error({file, 0}, "", file_.size() == 0 ? "is empty" : "is not a log of Dihaptic",
                    "Give a session's folder, or its raw.log.");
    }
    version_ = static_cast<int>(line_of - lines.begin()) + 1;
    end_ = static_cast<int64_t>(first.size());
    ChunkHeader header;
    if (!header_at(end_, header) || header.kind != kHead || header.size > kMostHead ||
        !read_at(end_, header)) {
        throw Error({file, 0}, "", "has no readable head",
                    "Nothing in it can be recovered: replace it with a backup.");
    }
    head_ = chunk_.payload;
    session_ = session_of(head_);
    due_ = 1;
    end_ += header_size() + header.size;
    first_ = end_;
}

/// Whether the header at this position belongs to one of the log's own chunks.
bool ChunkReader::is_next(const ChunkPlace& place, ChunkHeader& out) const {
    return header_at(place.at, out) && out.session == session_ &&
           (version_ == 1 || out.number == place.number) &&
           std::find(kKinds.begin(), kKinds.end(), out.kind) != kKinds.end();
}

std::vector<ChunkPlace> ChunkReader::places() const {
    std::vector<ChunkPlace> out;
    ChunkPlace place{first_, 1};
    ChunkHeader header;
    // bytes written after the file was opened are ignored
    while (place.at < file_.size() && is_next(place, header)) {
        const int64_t end = place.at + header_size() + header.size;
        if (end > file_.size()) return out;  // the chunk was not written completely
        if (has_frames(header.kind)) out.push_back(place);
        place = {end, place.number + 1};
    }
    if (place.at == file_.size()) return out;
    out.clear();
    ChunkReader all(name_);
    while (const Chunk* chunk = all.next()) {
        const bool own = chunk->place == Chunk::Place::own || chunk->place == Chunk::Place::moved;
        if (own && has_frames(chunk->kind)) out.push_back(chunk->in_file);
    }
    return out;
}

std::optional<ChunkPlace> ChunkReader::following(const ChunkPlace* last) {
    file_.look_again();
    ChunkPlace place{first_, 1};
    ChunkHeader header;
    if (last != nullptr) {
        if (!header_at(last->at, header)) return std::nullopt;
        place = {last->at + header_size() + header.size, last->number + 1};
    }
    const bool whole = is_next(place, header) && has_frames(header.kind) &&
                       place.at + header_size() + header.size <= file_.size();
    return whole ? std::optional(place) : std::nullopt;
}

void ChunkReader::go_to(const ChunkPlace& place) {
    end_ = place.at;
    due_ = place.number;
    done_ = looked_ = false;
    found_.clear();
    next_found_ = 0;
}

double ChunkReader::share() const {
    if (!looked_) return static_cast<double>(end_) / static_cast<double>(file_.size());
    return static_cast<double>(next_found_) / static_cast<double>(found_.size());
}

int64_t ChunkReader::header_size() const {
    return version_ == 1 ? sizeof(ChunkHeader1) : sizeof(ChunkHeader);
}

/// Reads the bytes at a position as a chunk header.
bool ChunkReader::header_at(int64_t at, ChunkHeader& out) const {
    if (version_ > 1)
        return file_.read(at, std::as_writable_bytes(std::span(&out, 1))) == sizeof(out);
    ChunkHeader1 header;
    const auto bytes = std::as_writable_bytes(std::span(&header, 1));
    if (file_.read(at, bytes) < bytes.size()) return false;
    out = {header.kind, header.size, session_, 0, header.checksum};
    return true;
}

/// Reads the chunk at a position; returns false if there is no chunk or if the chunk is damaged.
bool ChunkReader::read_at(int64_t at, ChunkHeader& out) {
    if (!header_at(at, out)) return false;
    if (out.size > kMostPayload || out.size > file_.size() - at - header_size()) return false;
    if (std::find(kKinds.begin(), kKinds.end(), out.kind) == kKinds.end()) return false;
    chunk_.payload.resize(out.size);
    const bool whole = file_.read(at + header_size(), chunk_.payload) == out.size;
    const uint32_t sum = version_ > 1
                             ? checksum(out, chunk_.payload)
                             : checksum(ChunkHeader1{out.kind, out.size, 0}, chunk_.payload);
    if (whole && sum == out.checksum) return true;
    wasted_ += out.size;
    return false;
}

/// Finds the first complete chunk at or after a position.
bool ChunkReader::find(int64_t from, Found& found, ChunkHeader& header) {
    for (int64_t at = from; at >= 0; at = find_kind(at + 1)) {
        if (!read_at(at, header)) {
            wasted_ += kBlock;  // the block is read again from at + 1
            continue;
        }
        found = {at, at + header_size() + header.size, at - from, header.number, Chunk::Place::own};
        if (header.session != session_) found.place = Chunk::Place::foreign;
        return true;
    }
    return false;
}

int64_t ChunkReader::find_kind(int64_t from) const {
    constexpr int64_t kOverlap = sizeof(uint32_t) - 1;  // a chunk's kind may span two blocks
    if (wasted_ > kMostWasted) return -1;
    std::string block;
    for (; from + kOverlap < file_.size(); from += kBlock - kOverlap) {
        block.resize(static_cast<size_t>(std::min(kBlock, file_.size() - from)));
        block.resize(file_.read(from, std::as_writable_bytes(std::span(block))));
        size_t found = std::string::npos;
        for (const uint32_t kind : kKinds) {
            const std::string_view letters(reinterpret_cast<const char*>(&kind), sizeof(kind));
            found = std::min(found, block.find(letters));
        }
        if (found != std::string::npos) return from + static_cast<int64_t>(found);
    }
    return -1;
}

const Chunk* ChunkReader::next() {
    if (looked_) return next_found();
    Found found;
    ChunkHeader header;
    if (!find(end_, found, header)) return nullptr;
    const bool due = version_ == 1 || (found.place == Chunk::Place::own && header.number == due_);
    if (!due) {
        look_through(found, header);
        return next_found();
    }
    end_ = found.end;
    return give(header, found);
}

/// Finds all chunks in the rest of the file and sorts them by number. If several chunks have the
/// same number, the first of them is used. A foreign chunk stays behind the chunk that it follows
/// in the file.
void ChunkReader::look_through(const Found& first, const ChunkHeader& header) {
    looked_ = true;
    auto last = static_cast<uint32_t>(due_ - 1);
    uint32_t highest = last;
    Found found = first;
    ChunkHeader next = header;
    bool more = true;
    for (; more; more = find(end_, found, next)) {
        if (found.place == Chunk::Place::foreign) {
            found.number = last;
        } else {
            last = found.number;
            if (last < highest) found.place = Chunk::Place::moved;
            highest = std::max(highest, last);
        }
        found_.push_back(found);
        end_ = found.end;
    }
    const auto key = [](const Found& f) {
        return std::pair(f.number, f.place == Chunk::Place::foreign);
    };
    std::stable_sort(found_.begin(), found_.end(),
                     [&](const Found& a, const Found& b) { return key(a) < key(b); });
}

const Chunk* ChunkReader::next_found() {
    while (next_found_ < found_.size()) {
        const Found& found = found_[next_found_++];
        ChunkHeader header;
        if (read_at(found.at, header)) return give(header, found);
    }
    return nullptr;
}

const Chunk* ChunkReader::give(const ChunkHeader& header, const Found& found) {
    chunk_.kind = header.kind;
    chunk_.in_file = {found.at, version_ == 1 ? 1 : header.number};
    chunk_.bytes = found.end - found.at;
    chunk_.damaged = found.damaged;
    chunk_.place = found.place;
    chunk_.missing = 0;
    if (done_) {
        chunk_.place = Chunk::Place::after_end;
    } else if (found.place != Chunk::Place::foreign && version_ > 1) {
        if (header.number < due_) {
            chunk_.place = Chunk::Place::doubled;
        } else {
            chunk_.missing = static_cast<int64_t>(header.number - due_);
            due_ = uint64_t{header.number} + 1;
        }
    }
    const bool own = chunk_.place == Chunk::Place::own || chunk_.place == Chunk::Place::moved;
    done_ = done_ || (own && header.kind == kDone);
    return &chunk_;
}

bool ChunkReader::tail_is_unfinished(int64_t& bytes) const {
    ChunkHeader header;
    bytes = 0;
    if (!header_at(end_, header)) return tail() > 0;
    const bool follows = header.kind == kData || header.kind == kPacked || header.kind == kDone;
    if (!follows || header.size > kMostPayload) return false;
    if (header.size <= tail() - header_size()) return false;
    bytes = header.size;
    return true;
}

}  // namespace dihaptic::recording
