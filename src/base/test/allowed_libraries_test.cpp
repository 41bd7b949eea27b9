// Tests the list of libraries that a user allows.
#include "base/allowed_libraries.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "base/diagnostics.h"
#include "base/temporary_folder.h"
#include "base/text_file.h"

namespace dihaptic::allowed_libraries_test {
namespace {

namespace fs = std::filesystem;

/// A user whose settings are in a temporary folder.
class AllowedLibraries : public ::testing::Test {
  protected:
    TemporaryFolder folder_;
    const std::string home_ = folder_.path();
    const std::string library_ = home_ + "/lib.so";
    AllowedLibraries() {
        setenv("XDG_CONFIG_HOME", home_.c_str(), 1);
        fs::create_directory(home_ + "/dihaptic");
        write_file("", library_);
    }
    ~AllowedLibraries() override { unsetenv("XDG_CONFIG_HOME"); }
    void list(const std::string& text) { write_file(text, allowed_libraries_file()); }
};

TEST_F(AllowedLibraries, AreThoseOfTheListWhateverLinkLeadsToThem) {
    EXPECT_EQ(allowed_libraries_file(), home_ + "/dihaptic/libraries.yaml");
    EXPECT_FALSE(is_allowed_library(library_));
    list("# mine\n- " + library_ + "\n");
    EXPECT_TRUE(is_allowed_library(library_));
    EXPECT_TRUE(
        is_allowed_library(home_ + "/../" + fs::path(home_).filename().string() + "/lib.so"));
    EXPECT_FALSE(is_allowed_library(home_ + "/other.so"));
    write_file("", home_ + "/other.so");
    EXPECT_FALSE(is_allowed_library(home_ + "/other.so"));
    list("\n");
    EXPECT_FALSE(is_allowed_library(library_));
}

TEST_F(AllowedLibraries, ThatAreNoListAreToldOf) {
    for (const char* text : {"library: /lib.so\n", "- lib.so\n", "- [/lib.so]\n", "- [\n"}) {
        list(text);
        EXPECT_THROW(is_allowed_library(library_), Error) << text;
    }
}

TEST_F(AllowedLibraries, OfNobodyAreNone) {
    unsetenv("XDG_CONFIG_HOME");
    const char* const before = std::getenv("HOME");
    const std::string home = before == nullptr ? "" : before;
    setenv("HOME", home_.c_str(), 1);
    EXPECT_EQ(allowed_libraries_file(), home_ + "/.config/dihaptic/libraries.yaml");
    unsetenv("HOME");
    EXPECT_EQ(allowed_libraries_file(), "");
    EXPECT_FALSE(is_allowed_library(library_));
    if (before != nullptr) setenv("HOME", home.c_str(), 1);
}

TEST(SystemLibraries, HaveNoFolder) {
    EXPECT_TRUE(is_system_library("libHD.so"));
    EXPECT_FALSE(is_system_library("./libHD.so"));
    EXPECT_FALSE(is_system_library("/usr/lib/libHD.so"));
}

}  // namespace
}  // namespace dihaptic::allowed_libraries_test
