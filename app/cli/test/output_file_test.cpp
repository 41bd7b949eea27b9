// Tests which files outputs may replace.
#include "common/output_file.h"

#include <gtest/gtest.h>

#include "base/diagnostics.h"
#include "base/text_file.h"
#include "session/record.h"
#include "testing/files.h"

namespace dihaptic::cli::output_file_test {
namespace {

bool may_write(const std::string& file, const std::string& ending) {
    try {
        app::check_output_file(file, "", "", ending);
        return true;
    } catch (const Error&) {
        return false;
    }
}

TEST(OutputFile, ReplacesOnlyWhatIsOfItsKind) {
    const testing::TemporaryFolder folder;
    EXPECT_TRUE(may_write(folder.file("new.csv"), ".csv"));
    EXPECT_TRUE(may_write(folder.write("old.csv", ""), ".csv"));
    EXPECT_FALSE(may_write(folder.write("scene.yaml", ""), ".csv"));
    EXPECT_FALSE(may_write(folder.file("none/new.csv"), ".csv"));
}

TEST(OutputFile, NeverReplacesWhatASessionConsistsOf) {
    const testing::TemporaryFolder parent;
    session::Request request;
    request.file = "scenes/block-on-table.yaml";
    session::RunOptions options;
    options.out = parent.path();
    const std::atomic<bool> stop{false};
    const auto folder = recording::SessionFolder::open(
        session::record(session::make_plan(request), options, stop).folder);
    EXPECT_TRUE(may_write(folder.file("mine.csv"), ".csv")) << "a new file replaces nothing";
    EXPECT_FALSE(may_write(folder.file("events.csv"), ".csv"));
    EXPECT_FALSE(may_write(folder.file("scene.yaml"), ".yaml"));
    const std::string picture = folder.file("texture-1-oak.png");
    write_file("oak", picture);
    EXPECT_TRUE(may_write(picture, ".png"));
    recording::SessionInfo info = folder.read_info();
    info.inputs.push_back(folder.input("texture-1-oak.png"));
    folder.write_info(info);
    EXPECT_FALSE(may_write(picture, ".png")) << "a texture of the session";
}

}  // namespace
}  // namespace dihaptic::cli::output_file_test
