// Tests at which positions the parts of a YAML text are found.
#include "base/written.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/text_file.h"

namespace dihaptic::written_test {
namespace {

/// Counts the plain scalars in a part of a text. Each of them must be at the position stated for
/// it.
int count_plain(const Written& part, const std::string& text) {
    int out = 0;
    for (const Written& item : part.items) out += count_plain(item, text);
    if (part.kind != Node::Kind::scalar || part.at >= text.size() ||
        std::string_view("\"'|>&!").find(text[part.at]) != std::string_view::npos)
        return out;
    const std::string first = part.scalar.substr(0, part.scalar.find_first_of(" \n"));
    EXPECT_EQ(text.substr(part.at, first.size()), first);
    return out + 1;
}

TEST(Written, PartsOfShippedFilesAreWhereTheyAre) {
    int count = 0;
    for (const char* folder : {"scenes", "rigs", "experiments", "populations", "studies"}) {
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            if (entry.path().extension() != ".yaml") continue;
            SCOPED_TRACE(entry.path().string());
            const std::string text = read_text_file(entry.path().string());
            count += count_plain(read_written(text), text);
        }
    }
    EXPECT_GT(count, 5000);
}

TEST(Written, TellsWhatStandsForSomethingElse) {
    const std::string text = "a: &x [1, '2', !!int 3]\r\nb: *x\r\nc: {d: 4, e: }\r\nü: \"ö\"\r\n";
    const Written root = read_written(text);
    EXPECT_FALSE(root.find("a")->alone);
    EXPECT_TRUE(root.find("a")->flow);
    EXPECT_TRUE(root.find("a")->items[0].alone);
    EXPECT_TRUE(root.find("a")->items[1].alone);
    EXPECT_FALSE(root.find("a")->items[2].alone);
    EXPECT_FALSE(root.find("b")->alone);
    EXPECT_EQ(root.find("c")->find("d")->at, text.find('4'));
    EXPECT_EQ(root.find("c")->find("e")->kind, Node::Kind::null);
    EXPECT_EQ(root.find("c")->column, 3);
    EXPECT_EQ(root.find("f"), nullptr);
    EXPECT_EQ(root.find("ü")->at, text.find("\"ö"));
    EXPECT_THROW(read_written("a: [1"), Error);
    EXPECT_EQ(read_written("").kind, Node::Kind::null);
}

TEST(Written, ChangesLeaveTheRestAsItIs) {
    EXPECT_EQ(changed("a: 1, b: 2", {{3, 1, "100"}, {6, 0, "and "}, {9, 1, ""}}),
              "a: 100, and b: ");
}

}  // namespace
}  // namespace dihaptic::written_test
