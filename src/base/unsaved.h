// The text of an editor that has not been saved: a thread that checks it reads it in place of the
// file's. So the file, and the folder that it is in, stay as they are until somebody saves, and
// what the text names is found from where the file is.
#pragma once

#include <string>

namespace dihaptic {

class Unsaved {
  public:
    /// As long as this lives, read_yaml(file) has this text in this thread, which has one such text
    /// at a time.
    Unsaved(std::string file, std::string text);
    ~Unsaved();
    Unsaved(const Unsaved&) = delete;
    Unsaved& operator=(const Unsaved&) = delete;

    /// What this thread reads in place of the file; null: the file.
    static const std::string* text_of(const std::string& file);

  private:
    std::string file_;
    std::string text_;
};

}  // namespace dihaptic
