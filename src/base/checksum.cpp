#include "base/checksum.h"

#include <fmt/format.h>
#include <zlib.h>

namespace dihaptic {

void Checksum::add(std::span<const std::byte> bytes) {
    sum_ = static_cast<uint32_t>(
        crc32_z(sum_, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string Checksum::text() const {
    return fmt::format("{:08x}", sum_);
}

std::string checksum_of(std::string_view bytes) {
    Checksum sum;
    sum.add(std::as_bytes(std::span(bytes)));
    return sum.text();
}

}  // namespace dihaptic
