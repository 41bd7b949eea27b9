// Tests the search for files that come with the program or that a user keeps for all studies.
#include "base/installed.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/temporary_folder.h"

namespace dihaptic::installed_test {
namespace {

namespace fs = std::filesystem;

TEST(Installed, WhatComesWithTheProgramIsFoundFromTheFolderThatItWasBuiltIn) {
    ASSERT_NE(shipped_folder(), "");
    EXPECT_TRUE(fs::is_directory(shipped_folder() + "/experiments"));
    EXPECT_EQ(kept("scenes/block-on-table.yaml"), shipped_folder() + "/scenes/block-on-table.yaml");
    EXPECT_EQ(kept("scenes"), shipped_folder() + "/scenes");
    EXPECT_EQ(kept("scenes/none.yaml"), "");
    EXPECT_EQ(kept(""), "");
    EXPECT_EQ(kept("/scenes/block-on-table.yaml"), "");
    EXPECT_EQ(in_or_above_program({"no-such-program"}), "");
}

TEST(Installed, TheUsersOwnFolderComesBeforeWhatIsShippedAndWhatIsThereBeforeBoth) {
    const TemporaryFolder folder;
    const std::string name = "scenes/block-on-table.yaml";
    const std::string own = folder.path() + "/dihaptic/" + name;
    fs::create_directories(fs::path(own).parent_path());
    std::ofstream(own) << "bodies: []\n";
    const char* before = std::getenv("XDG_DATA_HOME");
    const std::string was = before == nullptr ? "" : before;
    setenv("XDG_DATA_HOME", folder.path().c_str(), 1);
    EXPECT_EQ(kept(name), own);
    EXPECT_EQ(given_or_kept(name), name);  // the files exist in the folder in which tests run
    EXPECT_EQ(given_or_kept("block-on-table.yaml"), "block-on-table.yaml");
    fs::rename(own, folder.path() + "/dihaptic/scenes/mine.yaml");
    EXPECT_EQ(given_or_kept("scenes/mine.yaml"), folder.path() + "/dihaptic/scenes/mine.yaml");
    EXPECT_EQ(kept(name), shipped_folder() + "/" + name);
    before == nullptr ? unsetenv("XDG_DATA_HOME") : setenv("XDG_DATA_HOME", was.c_str(), 1);
}

TEST(Installed, ACopyOfAShippedFileFindsWhatItNamesWhereverItIs) {
    const TemporaryFolder folder;
    const std::string shipped = shipped_folder() + "/scenes/block-on-table.yaml";
    EXPECT_EQ(named_in(folder.path(), "../scenes/block-on-table.yaml"), shipped);
    EXPECT_EQ(named_in(folder.path(), "scenes/block-on-table.yaml"), shipped);
    EXPECT_EQ(named_in(folder.path(), "../none.yaml"),
              fs::path(folder.path()).parent_path().string() + "/none.yaml");
    std::ofstream(folder.file("none.yaml")) << "bodies: []\n";
    EXPECT_EQ(named_in(folder.path(), "none.yaml"), folder.file("none.yaml"));
    EXPECT_EQ(named_in(folder.path(), "/scenes/block-on-table.yaml"),
              "/scenes/block-on-table.yaml");
}

}  // namespace
}  // namespace dihaptic::installed_test
