// Records of a log, packed: those of one length that follow each other are turned, so that the
// first bytes of all stand together, then the second ones, and so on; then zstd compresses them.
// From tick to tick most bytes of a frame stay: turned, a chunk takes a fifth of its length.
//
//   packed   one zstd frame of blocks: u32 records, u32 bytes of each, the bytes turned
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace dihaptic::recording {

/// Bytes that packed records have at most: what claims to unpack to more is none.
constexpr size_t kMostUnpacked = 64u << 20;

class Packer {
  public:
    Packer();
    ~Packer();
    Packer(const Packer&) = delete;
    Packer& operator=(const Packer&) = delete;

    void add(std::span<const std::byte> record);
    /// Bytes of all records that were added, unpacked.
    size_t size() const { return records_.size(); }
    /// What was added since the last call, packed; valid until the next. Allocates only while
    /// chunks grow.
    std::span<const std::byte> pack();

  private:
    struct Block {
        uint32_t records = 0;
        uint32_t bytes = 0;  ///< of each
    };
    std::vector<std::byte> records_;
    std::vector<Block> blocks_;
    std::vector<std::byte> turned_;
    std::vector<std::byte> packed_;
    std::unique_ptr<ZSTD_CCtx_s, void (*)(ZSTD_CCtx_s*)> context_;
};

class Unpacker {
  public:
    Unpacker();

    /// The records, each u32 length and its bytes, valid until the next call; nothing when that is
    /// no whole pack.
    std::optional<std::span<const std::byte>> unpack(std::span<const std::byte> packed);

  private:
    bool turn_back(std::span<const std::byte> blocks);

    std::vector<std::byte> turned_;
    std::vector<std::byte> records_;
    std::unique_ptr<ZSTD_DCtx_s, void (*)(ZSTD_DCtx_s*)> context_;
};

}  // namespace dihaptic::recording
