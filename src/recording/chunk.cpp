#include "recording/chunk.h"

#include <zlib.h>

#include <bit>

namespace dihaptic::recording {
namespace {

static_assert(std::endian::native == std::endian::little, "the log is little-endian");

uint32_t crc(const void* header, size_t size, std::span<const std::byte> payload) {
    const uLong first = crc32_z(0, static_cast<const Bytef*>(header), size);
    return static_cast<uint32_t>(
        crc32_z(first, reinterpret_cast<const Bytef*>(payload.data()), payload.size()));
}

}  // namespace

uint64_t session_of(std::span<const std::byte> head) noexcept {
    uint64_t hash = 0xcbf29ce484222325;
    for (const std::byte byte : head) hash = (hash ^ static_cast<uint64_t>(byte)) * 0x100000001b3;
    return hash;
}

uint32_t checksum(const ChunkHeader& header, std::span<const std::byte> payload) noexcept {
    return crc(&header, offsetof(ChunkHeader, checksum), payload);
}

uint32_t checksum(const ChunkHeader1& header, std::span<const std::byte> payload) noexcept {
    return crc(&header, offsetof(ChunkHeader1, checksum), payload);
}

}  // namespace dihaptic::recording
