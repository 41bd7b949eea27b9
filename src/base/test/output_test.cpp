// Tests that output goes only to its own file, whatever already exists under the names that are
// used for it.
#include "base/output.h"
#include "base/number.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/diagnostics.h"
#include "base/temporary_folder.h"
#include "base/text_file.h"

namespace dihaptic::output_test {
namespace {

namespace fs = std::filesystem;

size_t count(const std::string& folder) {
    return static_cast<size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

struct OutputTest : ::testing::Test {
    TemporaryFolder folder;
    std::string foreign = folder.file("foreign");
    std::string file = folder.file("out");
    void SetUp() override { std::ofstream(foreign) << "theirs"; }
    void expect_untouched() const { EXPECT_EQ(read_text_file(foreign), "theirs"); }
};

TEST_F(OutputTest, LeavesPermissionsAsTheyWere) {
    for (const mode_t mode : {mode_t{0600}, mode_t{0640}, mode_t{0664}}) {
        write_file("one", file);
        ASSERT_EQ(::chmod(file.c_str(), mode), 0);
        write_file("two", file);
        struct stat there {};
        ASSERT_EQ(::stat(file.c_str(), &there), 0);
        EXPECT_EQ(there.st_mode & 07777, mode);
    }
}

TEST_F(OutputTest, ReplacesAFileWholeAndLeavesNothingElse) {
    write_file("one", file);
    write_file("two", file, Keep::at_once);
    EXPECT_EQ(read_text_file(file), "two");
    EXPECT_EQ(count(folder.path()), 2u);
}

TEST_F(OutputTest, WritesThroughNoLink) {
    fs::create_symlink(foreign, file);
    EXPECT_THROW(write_file("ours", file), Error);
    expect_untouched();
    fs::remove(file);
    fs::create_symlink(folder.file("nowhere"), file);
    EXPECT_THROW(write_file("ours", file), Error);
    EXPECT_FALSE(fs::exists(folder.file("nowhere")));
}

TEST_F(OutputTest, ReplacesOneNameOfAFileWithTwo) {
    fs::create_hard_link(foreign, file);
    write_file("ours", file);
    expect_untouched();
    EXPECT_EQ(read_text_file(file), "ours");
}

TEST_F(OutputTest, TakesNoPipeNorFolderForAFile) {
    ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
    EXPECT_THROW(write_file("ours", file), Error);
    EXPECT_TRUE(fs::is_fifo(file));
    fs::remove(file);
    fs::create_directory(file);
    EXPECT_THROW(write_file("ours", file), Error);
}

TEST_F(OutputTest, LinksAtNamesThatCanBeForeseenLeadNowhere) {
    // the path to which versions before 0.3 would have written
    fs::create_symlink(foreign, file + "." + number_text(getpid()) + ".part");
    write_file("ours", file);
    expect_untouched();
    EXPECT_EQ(read_text_file(file), "ours");
}

TEST_F(OutputTest, WhatIsNotKeptGoes) {
    {
        const Output output(file);
        std::ofstream(output.path()) << "half";
        EXPECT_EQ(fs::status(fs::path(output.path()).parent_path()).permissions(),
                  fs::perms::owner_all);
    }
    EXPECT_EQ(count(folder.path()), 1u);
}

TEST_F(OutputTest, RemovesPartsOfDeadProcessesOnly) {
    const auto part = [&](const std::string& process) {
        return file + "." + process + "-0badcafe.part";
    };
    const std::string dead = "999999999", alive = number_text(getpid());
    for (const std::string& process : {dead, alive}) {
        fs::create_directory(part(process));
        std::ofstream(part(process) + "/out") << "half";
    }
    fs::create_directory_symlink(folder.path(), part("999999998"));
    std::ofstream(file + "." + dead + ".part") << "of an older version";
    remove_dead_parts(file);
    EXPECT_FALSE(fs::exists(part(dead)));
    EXPECT_FALSE(fs::exists(file + "." + dead + ".part"));
    EXPECT_TRUE(fs::exists(part(alive)));
    expect_untouched();
}

TEST_F(OutputTest, FoldersAreMadeInRealFoldersOnly) {
    make_folders(folder.path(), "a/b/c");
    make_folders(folder.path(), "a/b/c");
    EXPECT_TRUE(fs::is_directory(folder.file("a/b/c")));
    fs::create_directory(folder.file("elsewhere"));
    fs::create_directory_symlink(folder.file("elsewhere"), folder.file("a/link"));
    EXPECT_THROW(make_folders(folder.path(), "a/link/d"), Error);
    EXPECT_EQ(count(folder.file("elsewhere")), 0u);
    EXPECT_THROW(make_folders(folder.path(), "foreign/d"), Error);
}

}  // namespace
}  // namespace dihaptic::output_test
