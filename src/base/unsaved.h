// Text in an editor that has not been saved. The thread that checks it reads this text in place
// of the file's, so that the file and its folder stay unchanged until the user saves, and paths in
// the text are still relative to the file.
#pragma once

#include <string>

namespace dihaptic {

class Unsaved {
  public:
    /// As long as this object lives, read_yaml(file) returns this text in this thread. A thread has
    /// one such text at a time.
    Unsaved(std::string file, std::string text);
    ~Unsaved();
    Unsaved(const Unsaved&) = delete;
    Unsaved& operator=(const Unsaved&) = delete;

    /// The text that this thread reads in place of the file; null: it reads the file.
    static const std::string* text_of(const std::string& file);

  private:
    std::string file_;
    std::string text_;
};

}  // namespace dihaptic
