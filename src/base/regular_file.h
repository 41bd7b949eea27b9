// Files that are read: regular ones alone. A pipe, a device or a folder in a file's place would
// keep the program waiting, or reading for ever.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace dihaptic {

/// A file that is open for reading.
class RegularFile {
  public:
    /// Throws Error when there is none, when it is something else, and when it cannot be opened.
    explicit RegularFile(const std::string& file);
    ~RegularFile();
    RegularFile(RegularFile&& other) noexcept;
    RegularFile& operator=(RegularFile&&) = delete;

    /// Bytes that it had when it was opened.
    int64_t size() const { return size_; }
    /// Reads from `at` on and returns how many bytes there were: fewer than asked for at the file's
    /// end. Throws Error when the disk cannot read them.
    size_t read(int64_t at, std::span<std::byte> out) const;

  private:
    std::string file_;
    int descriptor_ = -1;
    int64_t size_ = 0;
};

/// All bytes of a regular file. Throws Error, also when there are more than `most`.
std::string read_bytes(const std::string& file, int64_t most);

/// Whether anything has that name: also what is no file, or a link that leads nowhere. To read it
/// then says what is wrong with it.
bool is_there(const std::string& file) noexcept;

}  // namespace dihaptic
