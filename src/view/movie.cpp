#include "view/movie.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/shell_word.h"
#include "base/text_file.h"
#include "base/unix_socket.h"

namespace dihaptic::view {

Movie::Movie(const std::string& file, int width, int height, int frames_per_second)
    : file_(file), output_(file) {
    remove_dead_parts(file);
    if (width % 2 != 0 || height % 2 != 0)
        throw Error(fmt::format("a video cannot have the size {}x{}", width, height),
                    "Give an even width and height with --size.");
    // a socket, because writing to a pipe without a reader would terminate this program
    auto [ours, its] = unix_socket_pair(SOCK_STREAM);
    pictures_ = std::move(ours);
    said_ = Descriptor(memfd_create("ffmpeg", MFD_CLOEXEC));
    int error = pictures_ && said_ ? 0 : errno;
    const std::string options = fmt::format(
        "-hide_banner -loglevel error -y -f rawvideo -pix_fmt rgb24 -s {}x{} -r {} -i - "
        "-c:v libx264 -crf 18 -pix_fmt yuv420p -movflags +faststart -f mp4",
        width, height, frames_per_second);
    std::vector<std::string> arguments = shell_words(options).value();
    arguments.push_back("file:" + output_.path());
    // Ctrl-C must not reach ffmpeg, which would finish its file as if it were complete
    constexpr short kOwnGroup = POSIX_SPAWN_SETPGROUP;
    if (error == 0)
        error = ffmpeg_.start(
            {"ffmpeg", arguments, {its.get(), Launch::kNothing, said_.get()}, kOwnGroup});
    if (error == 0) return;
    if (error == ENOENT)
        throw Error("the program ffmpeg, which makes videos, is missing",
                    "Install it: sudo apt-get install ffmpeg.");
    throw Error(fmt::format("ffmpeg cannot be started: {}", std::strerror(error)),
                "End other programs and try again.");
}

/// Waits until ffmpeg has ended, and returns its exit status, which is 0 for success. May be called
/// repeatedly.
int Movie::wait() {
    pictures_.close();
    return ffmpeg_.wait().value_or(0);
}

void Movie::fail() {
    wait();
    std::array<char, 500> text{};
    const ssize_t size = pread(said_.get(), text.data(), text.size(), 0);
    std::string why(text.data(), size > 0 ? static_cast<size_t>(size) : 0);
    why = why.substr(0, why.find('\n'));
    throw Error({file_, 0}, "",
                "ffmpeg could not make the video: " + (why.empty() ? "it ended" : why),
                "Check that the disk has free space, and that you may write to the folder.");
}

void Movie::add(const Image& image) {
    size_t sent = 0;
    while (sent < image.rgb.size()) {
        const ssize_t n =
            send(pictures_.get(), image.rgb.data() + sent, image.rgb.size() - sent, MSG_NOSIGNAL);
        if (n > 0) sent += static_cast<size_t>(n);
        if (n < 0 && errno != EINTR) fail();
    }
}

void Movie::finish() {
    if (wait() != 0) fail();
    output_.keep();
}

}  // namespace dihaptic::view
