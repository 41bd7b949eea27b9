// Files for tests: a temporary folder that is removed at the end, and recorded data outside the
// repository.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "base/temporary_folder.h"

namespace dihaptic::testing {

class TemporaryFolder : public dihaptic::TemporaryFolder {
  public:
    /// Writes a file and returns its path.
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(file(name), std::ios::binary) << text;
        return file(name);
    }
};

inline std::string read_file(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

/// Path of recorded data beside the project's folder, or "" where they are absent.
inline std::string shared_data(const std::string& name) {
    const std::string path = "../shared/data/" + name;  // tests run in the project's folder
    return std::filesystem::exists(path) ? path : "";
}

}  // namespace dihaptic::testing

/// Skips the test, with a message, where the recorded data is absent.
#define DIHAPTIC_NEEDS_DATA(variable, name)                            \
    const std::string variable = dihaptic::testing::shared_data(name); \
    if (variable.empty()) GTEST_SKIP() << "../shared/data/" << name << " is absent"
