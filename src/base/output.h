// A file or folder that is being made. It gets its name only when it is complete, so that a reader
// finds no file, the old file or the new file. It is made in a folder whose name nobody else can
// predict and that nobody else can enter, so that nothing put next to it can redirect it.
#pragma once

#include <string>

namespace dihaptic {

class Output {
  public:
    /// Makes the folder `file`.PROCESS-RANDOM.part next to `file`, which must not be a link, a
    /// folder, or anything other than a file. Throws Error on failure.
    explicit Output(const std::string& file);
    /// Removes the file unless it was kept.
    ~Output();
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;

    /// The path at which the file or folder is made. Nothing exists there at first.
    const std::string& path() const { return path_; }
    /// Renames it to `file`, replacing an earlier one. Throws Error on failure.
    void keep();

  private:
    std::string file_;
    std::string folder_;
    std::string path_;
};

/// Removes the parts of `file` that killed programs have left.
void remove_dead_parts(const std::string& file);

/// Throws Error when the name belongs to a link, a folder, a pipe or a device: writing there would
/// go elsewhere or replace something other than a file.
void check_replaceable(const std::string& file);

/// Makes the folder `below` within `root`, and creates `root` and all folders between.
/// Throws Error when a folder cannot be made, or when one within `root` is a link, which would lead
/// outside.
void make_folders(const std::string& root, const std::string& below);

}  // namespace dihaptic
