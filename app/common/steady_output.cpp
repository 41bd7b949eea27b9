#include "common/steady_output.h"

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>

#include "common/console.h"

namespace dihaptic::cli {
namespace {

ssize_t write_to(void* stream, const char* data, size_t size) {
    const int file = static_cast<int>(reinterpret_cast<intptr_t>(stream));
    size_t done = 0;
    while (done < size) {
        const ssize_t written = write(file, data + done, size - done);
        if (written >= 0) {
            done += static_cast<size_t>(written);
        } else if (errno != EINTR) {
            const bool gone = errno == EPIPE || errno == EIO;
            if (gone) stop_requested.store(true);
            if (!gone) exit_code = kFailed;  // the disk may be full, so part of the output is lost
            break;
        }
    }
    return static_cast<ssize_t>(size);
}

FILE* steady(int file, int buffering) {
    FILE* const out = fopencookie(reinterpret_cast<void*>(static_cast<intptr_t>(file)), "w",
                                  {nullptr, write_to, nullptr, nullptr});
    if (out != nullptr) std::setvbuf(out, nullptr, buffering, BUFSIZ);
    return out;
}

}  // namespace

void make_output_steady() {
    FILE* const out = steady(STDOUT_FILENO, isatty(STDOUT_FILENO) != 0 ? _IOLBF : _IOFBF);
    FILE* const error = steady(STDERR_FILENO, _IONBF);
    if (out != nullptr) stdout = out;
    if (error != nullptr) stderr = error;
}

}  // namespace dihaptic::cli
