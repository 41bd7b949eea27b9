// Takes a raw.log apart into its chunks, so that tests can damage it as a disk, a program or a
// person might, and rewrites it as programs before version 2 wrote it.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "recording/chunk.h"
#include "recording/pack.h"

namespace dihaptic::testing {

using Bytes = std::string;
using recording::ChunkHeader;

inline std::span<const std::byte> bytes_of(const Bytes& text) {
    return std::as_bytes(std::span(text));
}

inline ChunkHeader header_of(const Bytes& chunk) {
    ChunkHeader header;
    std::memcpy(&header, chunk.data(), sizeof(header));
    return header;
}

inline Bytes payload_of(const Bytes& chunk) {
    return chunk.substr(sizeof(ChunkHeader));
}

/// A chunk whose size and checksum are right, whatever else is in it.
inline Bytes chunk_of(ChunkHeader header, const Bytes& payload) {
    header.size = static_cast<uint32_t>(payload.size());
    header.checksum = checksum(header, bytes_of(payload));
    return Bytes(reinterpret_cast<const char*>(&header), sizeof(header)) + payload;
}

/// A packed chunk as a chunk of plain records, which can be read and changed byte by byte.
inline Bytes unpacked(const Bytes& chunk) {
    ChunkHeader header = header_of(chunk);
    if (header.kind != recording::kPacked) return chunk;
    recording::Unpacker unpacker;
    const auto records = unpacker.unpack(bytes_of(payload_of(chunk))).value();
    header.kind = recording::kData;
    return chunk_of(header, Bytes(reinterpret_cast<const char*>(records.data()), records.size()));
}

/// The chunks of an undamaged log, unpacked; the head is the first.
inline std::vector<Bytes> take_apart(const Bytes& log) {
    std::vector<Bytes> out;
    for (size_t at = recording::kFirstLine.size(); at < log.size();) {
        const size_t size = sizeof(ChunkHeader) + header_of(log.substr(at)).size;
        out.push_back(unpacked(log.substr(at, size)));
        at += size;
    }
    return out;
}

inline Bytes put_together(const std::vector<Bytes>& chunks) {
    Bytes out(recording::kFirstLine);
    for (const Bytes& chunk : chunks) out += chunk;
    return out;
}

/// The same log as a program before version 2 wrote it.
inline Bytes as_version_1(const std::vector<Bytes>& chunks) {
    Bytes out(recording::kFirstLine1);
    for (const Bytes& chunk : chunks) {
        const Bytes payload = payload_of(chunk);
        recording::ChunkHeader1 header{header_of(chunk).kind, header_of(chunk).size, 0};
        header.checksum = checksum(header, bytes_of(payload));
        out += Bytes(reinterpret_cast<const char*>(&header), sizeof(header)) + payload;
    }
    return out;
}

enum class Mischief {
    swapped,
    doubled,
    dropped,
    foreign_between,
    foreign_instead,
    chunk_after_end,
    bytes_after_end,
    log_after_end,
    bytes_between,
};
constexpr int kMischiefs = 9;
constexpr const char* kMischiefNames[kMischiefs] = {
    "swapped",         "doubled",         "dropped",       "foreign_between", "foreign_instead",
    "chunk_after_end", "bytes_after_end", "log_after_end", "bytes_between"};

/// The log with one change that leaves every checksum right. `other`: a log of another
/// session. The head is kept: without it there is no log.
inline Bytes do_mischief(Mischief what, const Bytes& log, const Bytes& other,
                         std::mt19937_64& random) {
    std::vector<Bytes> chunks = take_apart(log);
    const std::vector<Bytes> others = take_apart(other);
    const auto pick = [&](size_t from, size_t end) {
        return std::uniform_int_distribution<size_t>(from, end - 1)(random);
    };
    const auto place = [&](size_t i) { return chunks.begin() + static_cast<std::ptrdiff_t>(i); };
    const size_t i = pick(1, chunks.size());
    const Bytes junk(pick(1, 5000), static_cast<char>(pick(0, 256)));
    switch (what) {
        case Mischief::swapped: {
            size_t k = pick(1, chunks.size() - 1);
            if (k >= i) ++k;
            std::swap(chunks[i], chunks[k]);
            break;
        }
        case Mischief::doubled:
            chunks.insert(place(pick(1, chunks.size() + 1)), Bytes(chunks[i]));
            break;
        case Mischief::dropped:
            chunks.erase(place(i));
            break;
        case Mischief::foreign_between:
            chunks.insert(place(i), others[pick(1, others.size())]);
            break;
        case Mischief::foreign_instead:
            chunks[i] = others[std::min(i, others.size() - 1)];
            break;
        case Mischief::chunk_after_end: {
            ChunkHeader header = header_of(chunks.back());
            const Bytes payload = payload_of(chunks[pick(1, chunks.size() - 1)]);
            header.kind = recording::kData;
            ++header.number;
            chunks.push_back(chunk_of(header, payload));
            break;
        }
        case Mischief::bytes_after_end:
            return log + junk;
        case Mischief::log_after_end:
            return log + other;
        case Mischief::bytes_between:
            chunks.insert(place(i), junk);
            break;
    }
    return put_together(chunks);
}

/// What a disk may do to bytes: flips, zeros, and stretches that are cut off, gone, or elsewhere.
inline Bytes damaged(Bytes text, const Bytes& other, std::mt19937_64& random) {
    const auto pick = [&](size_t from, size_t end) {
        return std::uniform_int_distribution<size_t>(from, std::max(from, end - 1))(random);
    };
    const size_t times = pick(1, 5);
    for (size_t n = 0; n < times && !text.empty(); ++n) {
        const size_t at = pick(0, text.size());
        const size_t length = pick(1, 1 + std::min<size_t>(6000, text.size() - at));
        switch (pick(0, 7)) {
            case 0:
                text[at] = static_cast<char>(text[at] ^ (1 << pick(0, 8)));
                break;
            case 1:
                text.resize(at);
                break;
            case 2:
                text.replace(at, length, Bytes(length, '\0'));
                break;
            case 3:
                text.erase(at, length);
                break;
            case 4:
                text.insert(pick(0, text.size()), text.substr(at, length));
                break;
            case 5:
                text += other.substr(pick(0, other.size()));
                break;
            default:
                for (size_t i = at; i < at + length && i < text.size(); ++i)
                    text[i] = static_cast<char>(pick(0, 256));
        }
    }
    return text;
}

/// Chunks that a program made up: any field and any byte may be anything, and the checksum is
/// right.
inline Bytes crafted(const Bytes& log, std::mt19937_64& random) {
    std::vector<Bytes> chunks = take_apart(log);
    const auto pick = [&](size_t from, size_t end) {
        return std::uniform_int_distribution<size_t>(from, std::max(from, end - 1))(random);
    };
    const bool in_head = pick(0, 4) == 0;
    for (size_t n = pick(1, 4); n > 0; --n) {
        Bytes& chunk = chunks[in_head ? 0 : pick(1, chunks.size())];
        ChunkHeader header = header_of(chunk);
        Bytes payload = payload_of(chunk);
        switch (pick(0, 6)) {
            case 0:
                header.number = static_cast<uint32_t>(random());
                break;
            case 1:
                header.kind = std::array{recording::kHead, recording::kData, recording::kPacked,
                                         recording::kDone, 0u}[pick(0, 5)];
                break;
            case 2:
                payload.resize(pick(0, payload.size() + 100));
                break;
            default:
                for (size_t i = pick(1, 20); i > 0 && !payload.empty(); --i) {
                    const size_t at = pick(0, payload.size());
                    // lengths of counts, indices, signs and exponents in the file
                    const size_t length = std::min<size_t>(1u << pick(0, 4), payload.size() - at);
                    const char to = std::array{'\0', '\xff', '\x7f', '9', '-'}[pick(0, 5)];
                    payload.replace(
                        at, length,
                        Bytes(length, pick(0, 2) == 0 ? to : static_cast<char>(random())));
                }
        }
        chunk = chunk_of(header, payload);
    }
    if (in_head) {  // the others' headers must name the same session
        const uint64_t session = recording::session_of(bytes_of(payload_of(chunks[0])));
        for (Bytes& chunk : chunks) {
            ChunkHeader header = header_of(chunk);
            header.session = session;
            chunk = chunk_of(header, payload_of(chunk));
        }
    }
    return put_together(chunks);
}

/// A log that is damaged, crafted, or both; `made_up`: data that were never recorded may have a
/// right checksum.
inline Bytes mutated(const Bytes& log, const Bytes& other, std::mt19937_64& random, bool& made_up) {
    const auto kind = random() % 4;
    made_up = kind >= 2;
    if (kind == 0) return damaged(log, other, random);
    if (kind == 1)
        return do_mischief(static_cast<Mischief>(random() % kMischiefs), log, other, random);
    const Bytes out = crafted(log, random);
    return kind == 2 ? out : damaged(out, other, random);
}

}  // namespace dihaptic::testing
