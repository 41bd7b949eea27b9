// Files for tests: a temporary folder that goes away, and the data that lies outside the
// repository.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace dihaptic::testing {

class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name =
            (std::filesystem::temp_directory_path() / "dihaptic-test-XXXXXX").string();
        if (mkdtemp(name.data()) != nullptr) path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::string& path() const { return path_; }
    std::string file(const std::string& name) const { return path_ + "/" + name; }
    /// Writes a file and returns its path.
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(file(name), std::ios::binary) << text;
        return file(name);
    }

  private:
    std::string path_;
};

inline std::string read_file(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

/// Recorded data beside the project's folder, or "" where it is absent.
inline std::string shared_data(const std::string& name) {
    const std::string path = "../shared/data/" + name;  // tests run in the project's folder
    return std::filesystem::exists(path) ? path : "";
}

}  // namespace dihaptic::testing

/// Skips the test, aloud, where the recorded data is absent.
#define DIHAPTIC_NEEDS_DATA(variable, name)                            \
    const std::string variable = dihaptic::testing::shared_data(name); \
    if (variable.empty()) GTEST_SKIP() << "../shared/data/" << name << " is absent"
