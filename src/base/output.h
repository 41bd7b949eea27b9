// A file or folder that is being made. It gets its name only when it is complete, so that a reader
// finds nothing, the old one or the new one. It is made in a folder whose name nobody else can
// foresee and that nobody else may enter, so that it cannot be redirected by anything that was put
// beside it.
#pragma once

#include <string>

namespace dihaptic {

class Output {
  public:
    /// Makes the folder `file`.PROCESS-RANDOM.part beside `file`, which must not be a link, a
    /// folder, or anything else than a file. Throws Error when it cannot.
    explicit Output(const std::string& file);
    /// Removes the file unless it was kept.
    ~Output();
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;

    /// The path at which the file or folder is made. Nothing exists there at first.
    const std::string& path() const { return path_; }
    /// Gives it its name, in place of the file that had it. Throws Error when it cannot.
    void keep();

  private:
    std::string file_;
    std::string folder_;
    std::string path_;
};

/// Removes the parts of `file` that killed programs left behind.
void remove_dead_parts(const std::string& file);

/// Throws Error when the name belongs to a link, a folder, a pipe or a device: writing there would
/// go elsewhere, or would replace something that is not a file.
void check_replaceable(const std::string& file);

/// Makes the folder `below` within `root`, which is made too, and any folder between the two.
/// Throws Error when one of them cannot be made, or when one within `root` is a link: it would lead
/// out.
void make_folders(const std::string& root, const std::string& below);

}  // namespace dihaptic
