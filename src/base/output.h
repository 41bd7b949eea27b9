// A file or folder that is being created. It gets its final name only when it is complete, so that
// a reader finds no file, the old file or the new file. Until then it is kept in a folder whose
// name nobody else can predict and that nobody else can enter, so that no link placed there can
// redirect it.
#pragma once

#include <string>

namespace dihaptic {

class Output {
  public:
    /// Creates the folder `file`.PROCESS-RANDOM.part next to `file`. The name `file` must not
    /// belong to a link, a folder, or anything other than a file. Throws Error on failure.
    explicit Output(const std::string& file);
    /// Removes the file unless keep() was called.
    ~Output();
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;

    /// The path at which the file or folder is to be created. Nothing exists there at first.
    const std::string& path() const { return path_; }
    /// Renames the file or folder to `file`, replacing an earlier one. Throws Error on failure.
    void keep();

  private:
    std::string file_;
    std::string folder_;
    std::string path_;
};

/// Removes the parts of `file` that programs left behind when they were killed.
void remove_dead_parts(const std::string& file);

/// Throws Error if the name belongs to a link, a folder, a pipe or a device, because writing to
/// that name would write elsewhere or replace something other than a file.
void check_replaceable(const std::string& file);

/// Creates the folder `below` within `root`, including `root` and all the folders in between.
/// Throws Error if a folder cannot be created, or if a folder within `root` is a link, which could
/// lead outside.
void make_folders(const std::string& root, const std::string& below);

}  // namespace dihaptic
