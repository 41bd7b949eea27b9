// Tests that the figures of a session's trials are computed while the session's log is still being
// written.
#include "analysis/running_trials.h"

#include <filesystem>
#include <fstream>

#include "base/table.h"
#include "session/test/sessions.h"

namespace dihaptic::session::running_trials_test {
namespace {

namespace fs = std::filesystem;

/// Number of cells in which a table differs from the corresponding cells of trials.csv.
size_t differences(const Table& table, const CsvFile& whole) {
    size_t out = 0;
    for (size_t row = 0; row < table.rows.size(); ++row) {
        for (size_t i = 0; i < table.columns.size(); ++i) {
            const std::string text = whole.text(row, table.columns[i].name);
            const Table::Cell& cell = table.rows[row][i];
            const auto* const said = std::get_if<std::string>(&cell);
            out += text != (said != nullptr ? *said : to_csv(cell)) ? 1 : 0;
        }
    }
    return out;
}

/// Feeds a session's log piece by piece, and compares the results with trials.csv.
void expect_found(const std::string& made, size_t least_rows) {
    const CsvFile whole(made + "/trials.csv");
    ASSERT_GE(whole.rows(), least_rows);
    std::string bytes;
    {
        std::ifstream file(made + "/raw.log", std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(file), {});
    }
    const testing::TemporaryFolder folder;
    fs::copy(made, folder.path(), fs::copy_options::recursive);
    std::ofstream log(folder.file("raw.log"), std::ios::binary);  // empties it
    const size_t head = bytes.size() / 4;
    log.write(bytes.data(), static_cast<std::streamsize>(head)).flush();
    analysis::RunningTrials trials(folder.path());
    EXPECT_EQ(trials.table().rows.size(), 0u);
    size_t ended = 0;
    for (size_t at = head; at < bytes.size();) {
        // pieces end anywhere, mostly in the middle of a chunk
        const size_t piece = std::min<size_t>(bytes.size() - at, 1 + bytes.size() / 37);
        log.write(bytes.data() + at, static_cast<std::streamsize>(piece)).flush();
        at += piece;
        trials.look();
        EXPECT_GE(trials.ended(), ended);
        ended = trials.ended();
    }
    size_t all = 0;
    for (size_t i = 0; i < whole.rows(); ++i)
        all += whole.text(i, "outcome") != "interrupted" ? 1 : 0;
    EXPECT_EQ(ended, all);
    const Table table = trials.table();
    EXPECT_EQ(table.rows.size(), whole.rows());
    EXPECT_EQ(differences(table, whole), 0u);
}

TEST(RunningTrials, AreThoseOfTheSessionWhenItIsOver) {
    Sessions sessions;
    expect_found(sessions.make(Mover::simulated_person), 4);
}

TEST(RunningTrials, KnowWhereBodiesRestInALogThatAThreadWrote) {
    Sessions sessions;
    sessions.files.replace("  reach: {",
                           "  custom_measures:\n    - { name: height_mm, of: block.z, take: min }\n"
                           "  reach: {");
    sessions.files.keep_first_block();
    const std::string made = sessions.make(Mover::simulated_person, true);
    EXPECT_NEAR(CsvFile(made + "/trials.csv").number(0, "height_mm"), 20, 0.1);
    expect_found(made, 1);
}

TEST(RunningTrials, AreToldFromNoTrials) {
    const testing::TemporaryFolder folder;
    Request request;
    request.file = "scenes/block-on-table.yaml";
    RunOptions options;
    options.out = folder.path();
    const Recorded session = record(make_plan(request), options, kGoOn);
    EXPECT_THROW(analysis::RunningTrials(session.folder), Error);
    EXPECT_THROW(analysis::RunningTrials(folder.path()), Error);
}

}  // namespace
}  // namespace dihaptic::session::running_trials_test
