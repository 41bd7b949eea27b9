// Checksums of files, by which damage and mix-ups show: CRC-32, in hexadecimal. Whoever means to
// forge a file can give it any checksum.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace dihaptic {

/// The checksum of bytes that come one part after the other.
class Checksum {
  public:
    void add(std::span<const std::byte> bytes);
    /// "0a1b2c3d"
    std::string text() const;

  private:
    uint32_t sum_ = 0;
};

std::string checksum_of(std::string_view bytes);

}  // namespace dihaptic
