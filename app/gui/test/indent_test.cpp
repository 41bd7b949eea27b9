// Tests how far a new line of a file is indented.
#include "indent.h"

#include <gtest/gtest.h>

namespace dihaptic::gui::indent_test {
namespace {

TEST(Indent, PutsKeysBelowKeys) {
    EXPECT_EQ(indent_after(""), 0);
    EXPECT_EQ(indent_after("title: A block"), 0);
    EXPECT_EQ(indent_after("    mass_g: 100    # of the block: all of it"), 4);
    EXPECT_EQ(indent_after("  - name: block"), 4);
    EXPECT_EQ(indent_after("  - \"name\": block"), 4);
    EXPECT_EQ(indent_after("  "), 2);
}

TEST(Indent, PutsValuesToTheRightOfTheirKey) {
    EXPECT_EQ(indent_after("bodies:"), 2);
    EXPECT_EQ(indent_after("  bodies:   # all"), 4);
    EXPECT_EQ(indent_after("  - exits:"), 6);
    EXPECT_EQ(indent_after("text: |"), 2);
    EXPECT_EQ(indent_after("hand: { centre_mm: [0, 0,"), 2);
}

TEST(Indent, PutsAnItemBelowAWholeItem) {
    EXPECT_EQ(indent_after("  - { name: index, shape: sphere }"), 2);
    EXPECT_EQ(indent_after("  - { when: inside }   # { soon"), 2);
    EXPECT_EQ(indent_after("- one"), 0);
    EXPECT_EQ(indent_after("  - [1, 2]"), 2);
    EXPECT_EQ(indent_after("  - - 3"), 4);
    EXPECT_EQ(indent_after("  - { name: index,"), 6);
}

}  // namespace
}  // namespace dihaptic::gui::indent_test
