// A file, or a folder, that is being made. It gets its name when it is whole, so that whoever reads
// finds either nothing, the old one or the new one; and it leads nowhere else, whatever somebody
// put beside it before, since it is made in a folder that nobody else knows the name of or may
// enter.
#pragma once

#include <string>

namespace dihaptic {

class Output {
  public:
    /// Makes the folder `file`.PROCESS-RANDOM.part beside `file`, which must not be a link, a
    /// folder, or anything else than a file. Throws Error when it cannot.
    explicit Output(const std::string& file);
    /// Removes what was not kept.
    ~Output();
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;

    /// Where the file, or folder, is made. Nothing is there at first.
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

/// Throws Error when the name belongs to a link, a folder, a pipe or a device: what is written
/// there would go elsewhere, or would replace what is no file.
void check_replaceable(const std::string& file);

/// Makes the folder `below` within `root`, which is made too, and any folder between the two.
/// Throws Error when one of them cannot be made, or when one within `root` is a link: it would lead
/// out.
void make_folders(const std::string& root, const std::string& below);

}  // namespace dihaptic
