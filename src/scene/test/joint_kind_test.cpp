// Tests that the documentation page on joints contains the table of joint kinds.
#include "scene/joint_kind.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "testing/files.h"

namespace dihaptic::scene::joint_kind_test {
namespace {

constexpr const char* kPage = "docs/files/joints.md";

std::string table_of_kinds() {
    std::string out = "| `kind` | leaves free | its coordinate |\n|---|---|---|\n";
    for (const JointKindRow& row : kJointKindTable) {
        out += fmt::format("| `{}` | {} | {}{}|\n", row.name, row.leaves_free, row.coordinate_is,
                           row.has_coordinate() ? " " : "");
    }
    return out;
}

/// The rest of the page is written by hand.
TEST(JointKinds, PageHasTheTable) {
    const std::string page = testing::read_file(kPage);
    const size_t begin = page.find("| `kind` |");
    const size_t end = page.find("\n\n", begin);
    ASSERT_NE(end, std::string::npos);
    const std::string made = page.substr(0, begin) + table_of_kinds() + page.substr(end + 1);
    if (std::getenv("DIHAPTIC_RENEW_TABLES") != nullptr) {
        std::ofstream(kPage) << made;
    } else {
        EXPECT_EQ(page, made) << kPage
                              << " says something else than the code. Renew it in the same commit: "
                                 "DIHAPTIC_RENEW_TABLES=1 build/release/src/scene/scene_test "
                                 "--gtest_filter='JointKinds.*'";
    }
    for (const JointKindRow& row : kJointKindTable)
        EXPECT_EQ(row.has_coordinate(), *row.coordinate_is != '\0') << row.name;
}

}  // namespace
}  // namespace dihaptic::scene::joint_kind_test
