#include "recording/pack.h"

#include <gtest/gtest.h>
#include <zstd.h>

#include <cstring>
#include <random>
#include <string>

namespace dihaptic::recording::pack_test {
namespace {

using Bytes = std::vector<std::byte>;

/// Records in the form an unpacker returns: each preceded by its length.
Bytes listed(const std::vector<Bytes>& records) {
    Bytes out;
    for (const Bytes& record : records) {
        const auto length = static_cast<uint32_t>(record.size());
        const auto head = std::as_bytes(std::span(&length, 1));
        out.insert(out.end(), head.begin(), head.end());
        out.insert(out.end(), record.begin(), record.end());
    }
    return out;
}

Bytes packed(Packer& packer, const std::vector<Bytes>& records) {
    for (const Bytes& record : records) packer.add(record);
    const auto out = packer.pack();
    return {out.begin(), out.end()};
}

/// Returns records with numbers as in a frame: one in four changes slowly, the others stay
/// constant.
std::vector<Bytes> smooth(size_t records) {
    std::vector<Bytes> out;
    for (size_t r = 0; r < records; ++r) {
        std::array<double, 100> values{};
        for (size_t i = 0; i < values.size(); ++i)
            values[i] =
                static_cast<double>(i) + (i % 4 == 0 ? 1e-4 * static_cast<double>(r * i) : 0);
        const auto bytes = std::as_bytes(std::span(values));
        out.emplace_back(bytes.begin(), bytes.end());
    }
    return out;
}

bool is_refused(const Bytes& pack) {
    return !Unpacker().unpack(pack).has_value();
}

/// Returns a complete zstd frame with invented contents.
Bytes compressed(const std::vector<uint32_t>& words) {
    Bytes out(ZSTD_compressBound(words.size() * sizeof(uint32_t)));
    out.resize(
        ZSTD_compress(out.data(), out.size(), words.data(), words.size() * sizeof(uint32_t), 1));
    return out;
}

TEST(Pack, GivesBackRecordsOfAnyLengthsInTheirOrder) {
    Packer packer;
    Unpacker unpacker;
    std::mt19937_64 random(1);
    for (int n = 0; n < 200; ++n) {
        std::vector<Bytes> records(random() % 60);
        for (Bytes& record : records) {
            record.resize(1 + random() % 3 * (random() % 500));
            for (std::byte& byte : record) byte = static_cast<std::byte>(random());
        }
        const auto got = unpacker.unpack(packed(packer, records));
        ASSERT_TRUE(got);
        EXPECT_EQ(Bytes(got->begin(), got->end()), listed(records));
    }
}

TEST(Pack, TakesAFractionOfWhatChangesLittle) {
    Packer packer;
    const std::vector<Bytes> records = smooth(50);
    EXPECT_LT(packed(packer, records).size(), listed(records).size() / 3);
    EXPECT_EQ(packer.size(), 0u);
}

TEST(Pack, RefusesWhatIsNotWhole) {
    Packer packer;
    const Bytes pack = packed(packer, smooth(5));
    EXPECT_FALSE(is_refused(pack));
    EXPECT_TRUE(is_refused({}));
    for (size_t size = 0; size < pack.size(); ++size)
        EXPECT_TRUE(is_refused(Bytes(pack.begin(), pack.begin() + static_cast<long>(size))));
}

TEST(Pack, RefusesBlocksThatAreNotThere) {
    EXPECT_FALSE(is_refused(compressed({1, 4, 0})));
    EXPECT_TRUE(is_refused(compressed({1})));
    EXPECT_TRUE(is_refused(compressed({2, 4, 0})));
    EXPECT_TRUE(is_refused(compressed({1, 5, 0})));
    EXPECT_TRUE(is_refused(compressed({0, 4})));
    EXPECT_TRUE(is_refused(compressed({0xffffffff, 0})));
    EXPECT_TRUE(is_refused(compressed({0xffffffff, 0xffffffff, 0})));
    EXPECT_TRUE(is_refused(compressed({1, 4, 0, 1})));
}

TEST(Pack, TakesNoMoreMemoryThanRecordsMay) {
    EXPECT_TRUE(is_refused(compressed(std::vector<uint32_t>(kMostUnpacked / 4 + 1))));
}

}  // namespace
}  // namespace dihaptic::recording::pack_test
