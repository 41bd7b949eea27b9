// Tests the message that the window shows when Python does not draw a page.
#include "common/drawn_report.h"

#include <gtest/gtest.h>

#include "base/installed.h"
#include "testing/files.h"

namespace dihaptic::app::drawn_report_test {
namespace {

TEST(DrawnReport, ThatPythonRefusesTellsTheWindowWhy) {
    const testing::TemporaryFolder folder;
    analysis::ReportResult result;
    result.paths = {folder.path()};
    try {
        PageDrawer(result.paths, PythonSays::in_error).draw(result, "dihaptic report");
        FAIL() << "there is no session";
    } catch (const Error& e) {
        const std::string why = e.what();
        EXPECT_EQ(why.find(folder.path() + ": error: has no report.html, because "), 0u) << why;
        // when a sanitizer is used, the Python package is not built
        if (in_or_above_program({"python/dihaptic/facts.json"}).empty()) return;
        EXPECT_NE(why.find("contains no completed sessions"), std::string::npos) << why;
    }
    folder.write("report.html", "of yesterday");
    try {
        PageDrawer(result.paths, PythonSays::in_error).draw(result, "dihaptic report");
        FAIL() << "there is no session";
    } catch (const Error& e) {
        const std::string why = e.what();
        EXPECT_NE(why.find(": error: has no new report.html, only an older one, because "),
                  std::string::npos)
            << why;
    }
}

}  // namespace
}  // namespace dihaptic::app::drawn_report_test
