// Tests that an unsaved text replaces a file's text, but only in its own thread and during its
// lifetime.
#include "base/unsaved.h"

#include <gtest/gtest.h>

#include <thread>

#include "base/node.h"
#include "base/temporary_folder.h"
#include "base/text_file.h"

namespace dihaptic::unsaved_test {
namespace {

TEST(Unsaved, IsReadInPlaceOfTheFile) {
    const TemporaryFolder folder;
    const std::string file = folder.file("a.yaml"), other = folder.file("b.yaml");
    write_file("of: disk\n", file);
    write_file("of: disk\n", other);
    const auto of = [](const std::string& name) { return read_yaml(name).find("of")->scalar; };
    {
        const Unsaved unsaved(file, "of: editor\n");
        EXPECT_EQ(of(file), "editor");
        EXPECT_EQ(read_yaml(file).place.file, file) << "messages name the file";
        EXPECT_EQ(of(other), "disk");
        std::thread([&] { EXPECT_EQ(of(file), "disk"); }).join();
    }
    EXPECT_EQ(of(file), "disk");
}

TEST(Unsaved, NeedsNoFile) {
    const TemporaryFolder folder;
    const Unsaved unsaved(folder.file("gone.yaml"), "of: editor\n");
    EXPECT_EQ(read_yaml(folder.file("gone.yaml")).find("of")->scalar, "editor");
}

}  // namespace
}  // namespace dihaptic::unsaved_test
