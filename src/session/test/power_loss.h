// Simulates a power failure: for each file, the disk keeps only the contents at the last
// synchronisation; for each folder, it keeps only the names that existed at that time.
//
// This replaces fsync() in the program that includes this header; include it in one source file.
#pragma once

#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "base/number.h"
#include "testing/files.h"

namespace dihaptic::testing {

class Disk {
  public:
    using Clock = std::chrono::steady_clock;

    Disk() { current_ = this; }
    ~Disk() {
        const std::lock_guard lock(guard_);
        current_ = nullptr;
    }
    Disk(const Disk&) = delete;
    Disk& operator=(const Disk&) = delete;

    /// Called after each synchronisation, by the thread that requested it.
    std::function<void()> synced;

    /// Writes to the folder `to` what would be left of `folder` if power failed now.
    void lose_power(const std::string& folder, const std::string& to) {
        const std::lock_guard lock(guard_);
        restore(inode_of(folder), to);
    }
    /// Returns the time when the last synchronisation of the file began.
    Clock::time_point last_sync(const std::string& file) {
        const std::lock_guard lock(guard_);
        return times_[inode_of(file)];
    }

    static int sync(int descriptor) {
        std::function<void()> after;
        {
            const std::lock_guard lock(guard_);
            if (current_ == nullptr) return 0;
            current_->keep(descriptor);
            after = current_->synced;
        }
        if (after) after();
        return 0;
    }

  private:
    struct Entry {
        ino_t inode = 0;
        bool folder = false;
    };
    static ino_t inode_of(const std::string& name) {
        struct stat status {};
        stat(name.c_str(), &status);
        return status.st_ino;
    }
    void keep(int descriptor) {
        const auto now = Clock::now();
        struct stat status {};
        fstat(descriptor, &status);
        times_[status.st_ino] = now;
        const std::string name = "/proc/self/fd/" + number_text(descriptor);
        if (!S_ISDIR(status.st_mode)) {
            files_[status.st_ino] = read_file(name);
            return;
        }
        std::map<std::string, Entry>& names = folders_[status.st_ino];
        names.clear();
        std::error_code gone;
        const auto options = std::filesystem::directory_options::skip_permission_denied;
        for (const auto& entry : std::filesystem::directory_iterator(name, options, gone)) {
            names[entry.path().filename().string()] = {inode_of(entry.path().string()),
                                                       entry.is_directory(gone)};
        }
    }
    void restore(ino_t folder, const std::string& to) {
        std::filesystem::create_directories(to);
        for (const auto& [name, entry] : folders_[folder]) {
            if (entry.folder) {
                restore(entry.inode, to + "/" + name);
            } else {
                std::ofstream(to + "/" + name, std::ios::binary) << files_[entry.inode];
            }
        }
    }

    static inline std::mutex guard_;
    static inline Disk* current_ = nullptr;
    std::map<ino_t, std::string> files_;
    std::map<ino_t, std::map<std::string, Entry>> folders_;
    std::map<ino_t, Clock::time_point> times_;
};

}  // namespace dihaptic::testing

extern "C" int fsync(int descriptor) {
    return dihaptic::testing::Disk::sync(descriptor);
}
