#include "base/regular_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/diagnostics.h"

namespace dihaptic {
namespace {

[[noreturn]] void refuse(const std::string& file, int why) {
    if (why == EACCES) {
        throw Error({file, 0}, "", "cannot be read: you do not have permission to read it",
                    "Give yourself the permission, e.g. with chmod u+r.");
    }
    throw Error({file, 0}, "", fmt::format("cannot be read: {}", std::strerror(why)),
                "Check the name and the folder.");
}

}  // namespace

RegularFile::RegularFile(const std::string& file)
    : file_(file),
      // without O_NONBLOCK, open() would wait on a pipe that has no writer
      descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {
    if (!descriptor_ && errno != ENXIO) refuse(file, errno);
    struct stat status {};
    if (descriptor_ && ::fstat(descriptor_.get(), &status) == 0 && S_ISREG(status.st_mode)) {
        size_ = status.st_size;
        return;
    }
    if (S_ISDIR(status.st_mode)) throw Error({file, 0}, "", "is a folder", "Name a file in it.");
    throw Error({file, 0}, "", "is not a file, but a pipe, a socket or a device",
                "Replace it with a file that contains a copy of its output.");
}

void RegularFile::look_again() {
    struct stat status {};
    if (::fstat(descriptor_.get(), &status) == 0) size_ = status.st_size;
}

size_t RegularFile::read(int64_t at, std::span<std::byte> out) const {
    size_t done = 0;
    while (done < out.size()) {
        const ssize_t n = ::pread(descriptor_.get(), out.data() + done, out.size() - done,
                                  at + static_cast<int64_t>(done));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) refuse(file_, errno);
        if (n == 0) break;
        done += static_cast<size_t>(n);
    }
    return done;
}

std::string read_bytes(const std::string& file, int64_t most) {
    const RegularFile in(file);
    if (in.size() > most) {
        throw Error({file, 0}, "",
                    fmt::format("is {} MB large; {} MB are allowed", in.size() / 1'000'000,
                                most / 1'000'000),
                    "Check that it is the right file.");
    }
    std::string text(static_cast<size_t>(in.size()), '\0');
    text.resize(in.read(0, std::as_writable_bytes(std::span(text))));
    return text;
}

bool is_there(const std::string& file) noexcept {
    struct stat status {};
    return ::lstat(file.c_str(), &status) == 0 || errno == EACCES;
}

}  // namespace dihaptic
