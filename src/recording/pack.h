// Packs the records of a log chunk. Consecutive records of the same length are transposed: the
// first bytes of all records come first, then their second bytes, and so on. The result is
// compressed with zstd. Since most bytes of a frame stay the same from tick to tick, a packed chunk
// has about a quarter of its original length.
//
//   packed   one zstd frame of blocks: u32 number of records, u32 bytes of each, transposed bytes
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

/// Largest size of the unpacked records [bytes]; data that claim a larger size are not a pack.
constexpr size_t kMostUnpacked = 64u << 20;

class Packer {
  public:
    Packer();
    ~Packer();
    Packer(const Packer&) = delete;
    Packer& operator=(const Packer&) = delete;

    void add(std::span<const std::byte> record);
    /// Number of bytes added since the last pack().
    size_t size() const { return records_.size(); }
    /// Packs the records added since the last call. The result is valid until the next call.
    std::span<const std::byte> pack();

  private:
    struct Block {
        uint32_t records = 0;
        uint32_t bytes = 0;  ///< size of each record [bytes]
    };
    std::vector<std::byte> records_;
    std::vector<Block> blocks_;
    std::vector<std::byte> transposed_;
    std::vector<std::byte> packed_;
    std::unique_ptr<ZSTD_CCtx_s, void (*)(ZSTD_CCtx_s*)> context_;
};

class Unpacker {
  public:
    Unpacker();

    /// Returns the records, each preceded by its length (u32); they are valid until the next call.
    /// Returns nullopt if the bytes are not a complete pack.
    std::optional<std::span<const std::byte>> unpack(std::span<const std::byte> packed);

  private:
    bool restore(std::span<const std::byte> blocks);

    std::vector<std::byte> transposed_;
    std::vector<std::byte> records_;
    std::unique_ptr<ZSTD_DCtx_s, void (*)(ZSTD_DCtx_s*)> context_;
};

}  // namespace dihaptic::recording
