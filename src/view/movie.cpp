#include "view/movie.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/text_file.h"

namespace dihaptic::view {
namespace {

/// Starts ffmpeg. Returns 0, or the number of the error.
int start(const std::vector<std::string>& words, int in, int err, int& process) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, in, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files, err, STDERR_FILENO);
    posix_spawnattr_t how;
    posix_spawnattr_init(&how);
    // Ctrl-C is for this program only: ffmpeg would end its file as if it were complete
    posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP);
    const int error = posix_spawnp(&process, "ffmpeg", &files, &how, arguments.data(), environ);
    posix_spawnattr_destroy(&how);
    posix_spawn_file_actions_destroy(&files);
    return error;
}

}  // namespace

Movie::Movie(const std::string& file, int width, int height, int frames_per_second)
    : file_(file), output_(file) {
    remove_dead_parts(file);
    if (width % 2 != 0 || height % 2 != 0)
        throw Error(fmt::format("a video cannot have the size {}x{}", width, height),
                    "Give an even width and height with --size.");
    // a socket, because writing to a pipe without a reader would end this program
    std::array<int, 2> ends{-1, -1};
    said_ = memfd_create("ffmpeg", MFD_CLOEXEC);
    int error = 0;
    if (said_ < 0 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
        error = errno;
    } else {
        pictures_ = ends[0];
        error = start({"ffmpeg",
                       "-hide_banner",
                       "-loglevel",
                       "error",
                       "-y",
                       "-f",
                       "rawvideo",
                       "-pix_fmt",
                       "rgb24",
                       "-s",
                       fmt::format("{}x{}", width, height),
                       "-r",
                       fmt::format("{}", frames_per_second),
                       "-i",
                       "-",
                       "-c:v",
                       "libx264",
                       "-crf",
                       "18",
                       "-pix_fmt",
                       "yuv420p",
                       "-movflags",
                       "+faststart",
                       "-f",
                       "mp4",
                       "file:" + output_.path()},
                      ends[1], said_, process_);
        close(ends[1]);
    }
    if (error == 0) return;
    if (pictures_ >= 0) close(pictures_);
    if (said_ >= 0) close(said_);
    if (error == ENOENT)
        throw Error("the program ffmpeg, which makes videos, is missing",
                    "Install it: sudo apt-get install ffmpeg.");
    throw Error(fmt::format("ffmpeg cannot be started: {}", std::strerror(error)),
                "End other programs and try again.");
}

Movie::~Movie() {
    if (process_ >= 0) {
        kill(process_, SIGKILL);
        wait();
    }
    close(said_);
}

/// Waits until ffmpeg ends; returns its exit status, 0 for success. May be called again.
int Movie::wait() {
    if (pictures_ >= 0) close(std::exchange(pictures_, -1));
    int status = 0;
    while (process_ >= 0 && waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
    process_ = -1;
    return status;
}

void Movie::fail() {
    wait();
    std::array<char, 500> text{};
    const ssize_t size = pread(said_, text.data(), text.size(), 0);
    std::string why(text.data(), size > 0 ? static_cast<size_t>(size) : 0);
    why = why.substr(0, why.find('\n'));
    throw Error({file_, 0}, "",
                "ffmpeg could not make the video: " + (why.empty() ? "it ended" : why),
                "Check that the disk has space, and that the folder is writable.");
}

void Movie::add(const Image& image) {
    size_t sent = 0;
    while (sent < image.rgb.size()) {
        const ssize_t n =
            send(pictures_, image.rgb.data() + sent, image.rgb.size() - sent, MSG_NOSIGNAL);
        if (n > 0) sent += static_cast<size_t>(n);
        if (n < 0 && errno != EINTR) fail();
    }
}

void Movie::finish() {
    if (wait() != 0) fail();
    output_.keep();
}

}  // namespace dihaptic::view
