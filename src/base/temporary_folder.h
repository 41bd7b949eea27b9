#pragma once

#include <string>

namespace dihaptic {

/// A new folder in the system's temporary folder. On destruction the folder is deleted with
/// everything in it. Throws Error if the folder cannot be created.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::string& path() const { return path_; }
    std::string file(const std::string& name) const { return path_ + "/" + name; }

  private:
    std::string path_;
};

}  // namespace dihaptic
