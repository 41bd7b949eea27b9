// Checksums of files (CRC-32, in hexadecimal). They reveal damage and mix-ups, but do not prevent
// forgery.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace dihaptic {

/// Computes the checksum of bytes that arrive in several parts.
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
