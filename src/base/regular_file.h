// Reads regular files only. A pipe or a device in place of a file could keep the program waiting or
// reading for ever.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "base/descriptor.h"

namespace dihaptic {

/// A file open for reading.
class RegularFile {
  public:
    /// Opens the file. Throws Error if it does not exist, is not a regular file, or cannot be
    /// opened.
    explicit RegularFile(const std::string& file);

    /// Size of the file when it was opened or, if look_again() has been called, at the last call
    /// [bytes].
    int64_t size() const { return size_; }
    /// Updates the size, which may change while another program is writing the file.
    void look_again();
    /// Reads from byte `at` onwards and returns the number of bytes read, which is smaller than
    /// out.size() only at the end of the file. Throws Error if the bytes cannot be read.
    size_t read(int64_t at, std::span<std::byte> out) const;

  private:
    std::string file_;
    Descriptor descriptor_;
    int64_t size_ = 0;
};

/// All bytes of a regular file. Throws Error if the file cannot be read or is larger than `most`
/// [bytes].
std::string read_bytes(const std::string& file, int64_t most);

/// Whether anything has this name, even a dangling link or something other than a file; the problem
/// is reported when it is read. Also true if a folder on the path cannot be searched.
bool is_there(const std::string& file) noexcept;

}  // namespace dihaptic
