#include "base/child.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>

namespace dihaptic {

int Child::start(const Launch& launch) {
    std::vector<char*> words{const_cast<char*>(launch.program.c_str())};
    for (const std::string& word : launch.arguments)
        words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    int file = 0;
    for (const int ours : launch.files) {
        if (ours >= 0) posix_spawn_file_actions_adddup2(&files, ours, file);
        if (ours == Launch::kNothing)
            posix_spawn_file_actions_addopen(&files, file, "/dev/null", O_RDWR, 0);
        ++file;
    }
    posix_spawn_file_actions_addclosefrom_np(&files, file);
    posix_spawnattr_t how;
    posix_spawnattr_init(&how);
    sigset_t all;
    sigset_t none;
    sigfillset(&all);
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&how, &all);
    posix_spawnattr_setsigmask(&how, &none);
    posix_spawnattr_setflags(&how, launch.flags);
    const int error = posix_spawnp(&process_, words[0], &files, &how, words.data(), environ);
    if (error != 0) process_ = 0;
    posix_spawnattr_destroy(&how);
    posix_spawn_file_actions_destroy(&files);
    return error;
}

Child::~Child() {
    if (process_ > 0) kill(process_, SIGKILL);
    wait();
}

/// Returns whether the child has ended. Once it has, its process number may be given to another
/// program.
bool Child::reap(int options) noexcept {
    if (process_ == 0) return true;
    int status = 0;
    pid_t ended = -1;
    do {
        ended = waitpid(process_, &status, options);
    } while (ended < 0 && errno == EINTR);
    if (ended == 0) return false;
    if (ended > 0) status_ = status;
    process_ = 0;
    return true;
}

}  // namespace dihaptic
