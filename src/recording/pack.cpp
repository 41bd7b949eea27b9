#include "recording/pack.h"

#include <zstd.h>

#include <cstring>
#include <new>

namespace dihaptic::recording {
namespace {

/// Compression level. Level 3 would take twice as long and make the result only 2 % smaller.
constexpr int kLevel = 1;

}  // namespace

Packer::Packer()
    : context_(ZSTD_createCCtx(), [](ZSTD_CCtx_s* context) { ZSTD_freeCCtx(context); }) {
    if (context_ == nullptr) throw std::bad_alloc();
}

Packer::~Packer() = default;

void Packer::add(std::span<const std::byte> record) {
    const auto bytes = static_cast<uint32_t>(record.size());
    if (blocks_.empty() || blocks_.back().bytes != bytes) blocks_.push_back({0, bytes});
    ++blocks_.back().records;
    records_.insert(records_.end(), record.begin(), record.end());
}

std::span<const std::byte> Packer::pack() {
    transposed_.resize(records_.size() + blocks_.size() * sizeof(Block));
    const std::byte* from = records_.data();
    std::byte* to = transposed_.data();
    for (const Block& block : blocks_) {
        std::memcpy(to, &block, sizeof(block));
        to += sizeof(block);
        for (size_t byte = 0; byte < block.bytes; ++byte) {
            for (size_t record = 0; record < block.records; ++record)
                *to++ = from[record * block.bytes + byte];
        }
        from += size_t{block.records} * block.bytes;
    }
    packed_.resize(ZSTD_compressBound(transposed_.size()));
    // This cannot fail: the buffer has room for the worst case.
    packed_.resize(ZSTD_compressCCtx(context_.get(), packed_.data(), packed_.size(),
                                     transposed_.data(), transposed_.size(), kLevel));
    records_.clear();
    blocks_.clear();
    return packed_;
}

Unpacker::Unpacker()
    : context_(ZSTD_createDCtx(), [](ZSTD_DCtx_s* context) { ZSTD_freeDCtx(context); }) {
    if (context_ == nullptr) throw std::bad_alloc();
}

std::optional<std::span<const std::byte>> Unpacker::unpack(std::span<const std::byte> packed) {
    const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
    // The return values for an unknown size and for an error are larger than any size.
    if (size > kMostUnpacked) return std::nullopt;
    transposed_.resize(size);
    const size_t got = ZSTD_decompressDCtx(context_.get(), transposed_.data(), transposed_.size(),
                                           packed.data(), packed.size());
    if (ZSTD_isError(got) != 0 || got != size || !restore(transposed_)) return std::nullopt;
    return records_;
}

bool Unpacker::restore(std::span<const std::byte> blocks) {
    records_.clear();
    while (!blocks.empty()) {
        uint32_t head[2];  // number of records, and size of each record [bytes]
        if (blocks.size() < sizeof(head)) return false;
        std::memcpy(head, blocks.data(), sizeof(head));
        blocks = blocks.subspan(sizeof(head));
        const size_t records = head[0];
        const size_t bytes = head[1];
        // Without this check, a block could claim any number of empty records.
        if (records == 0 || bytes == 0 || blocks.size() / bytes < records) return false;
        const size_t first = records_.size();
        const size_t stride = sizeof(uint32_t) + bytes;
        records_.resize(first + records * stride);
        for (size_t record = 0; record < records; ++record) {
            std::byte* const to = records_.data() + first + record * stride;
            std::memcpy(to, &head[1], sizeof(uint32_t));
            for (size_t byte = 0; byte < bytes; ++byte)
                to[sizeof(uint32_t) + byte] = blocks[byte * records + record];
        }
        blocks = blocks.subspan(records * bytes);
    }
    return true;
}

}  // namespace dihaptic::recording
