// The format of raw.log, byte for byte: a first line, then chunks.
//
//   "DIHAPTIC LOG 3\n"
//   chunk   u32 kind, u32 bytes of payload, u64 session, u32 number, u32 CRC-32, payload
//
// The kind is four letters: HEAD, PACK, DATA or DONE. `session` is the FNV-1a hash of the head's
// payload. Chunks are numbered in order; the head has number 0. These two values reveal chunks of
// another session and chunks that are out of place. The CRC-32 covers the preceding part of the
// header and the payload.
//
// Version 2 had no packed chunks. In version 1, chunks had neither session nor number: u32 kind,
// u32 bytes of payload, u32 CRC-32, payload.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace dihaptic::recording {

constexpr std::string_view kFirstLine = "DIHAPTIC LOG 3\n";
constexpr std::string_view kFirstLine2 = "DIHAPTIC LOG 2\n";
constexpr std::string_view kFirstLine1 = "DIHAPTIC LOG 1\n";

constexpr uint32_t kHead = 0x44414548;    // "HEAD"
constexpr uint32_t kData = 0x41544144;    // "DATA"
constexpr uint32_t kPacked = 0x4B434150;  // "PACK"
constexpr uint32_t kDone = 0x454E4F44;    // "DONE"
/// Largest payload [bytes]. If a header states more, the data are not a chunk.
constexpr uint32_t kMostPayload = 1u << 28;
/// Largest payload of a head chunk, which contains text [bytes].
constexpr uint32_t kMostHead = 1u << 24;

struct ChunkHeader {
    uint32_t kind = 0;
    uint32_t size = 0;
    uint64_t session = 0;
    uint32_t number = 0;
    uint32_t checksum = 0;
};
static_assert(sizeof(ChunkHeader) == 24);

/// The header in version 1.
struct ChunkHeader1 {
    uint32_t kind = 0;
    uint32_t size = 0;
    uint32_t checksum = 0;
};
static_assert(sizeof(ChunkHeader1) == 12);

/// Returns the value of `session` that all chunks have in the log with this head.
uint64_t session_of(std::span<const std::byte> head) noexcept;
/// Returns the checksum of a header (excluding the checksum itself) and of its payload.
uint32_t checksum(const ChunkHeader& header, std::span<const std::byte> payload) noexcept;
uint32_t checksum(const ChunkHeader1& header, std::span<const std::byte> payload) noexcept;

}  // namespace dihaptic::recording
