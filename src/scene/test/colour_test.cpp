#include "scene/colour.h"

#include <gtest/gtest.h>

namespace dihaptic::scene::colour_test {
namespace {

TEST(Colour, IsRedGreenAndBlueInHexadecimal) {
    EXPECT_EQ(colour_of("#123456"), 0x123456);
    EXPECT_EQ(colour_of("#Ff00aB"), 0xff00ab);
    for (const char* none : {"", "#", "#12345", "#1234567", "123456", "#12345g", "#-12345", "red"})
        EXPECT_FALSE(colour_of(none)) << none;
}

}  // namespace
}  // namespace dihaptic::scene::colour_test
