// Text in an editor that has not been saved yet. The thread that checks the text reads it in place
// of the file, so that the file and its folder stay unchanged until the user saves, while paths in
// the text are still relative to the file.
#pragma once

#include <string>

namespace dihaptic {

class Unsaved {
  public:
    /// As long as this object exists, read_yaml(file) in this thread reads this text. A thread has
    /// at most one such text at a time.
    Unsaved(std::string file, std::string text);
    ~Unsaved();
    Unsaved(const Unsaved&) = delete;
    Unsaved& operator=(const Unsaved&) = delete;

    /// The text that this thread reads in place of the file; null if it reads the file itself.
    static const std::string* text_of(const std::string& file);

  private:
    std::string file_;
    std::string text_;
};

}  // namespace dihaptic
