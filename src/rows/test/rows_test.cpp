// Tests that reading a session's table gives the same rows that were written.
#include <gtest/gtest.h>

#include <cmath>

#include "base/number.h"
#include "rows/episode_row.h"
#include "rows/event_row.h"
#include "rows/lift_row.h"
#include "rows/phase_row.h"
#include "rows/procedure_row.h"
#include "rows/trial_row.h"
#include "testing/files.h"

namespace dihaptic::rows::rows_test {
namespace {

/// Gives each member that a row lists a different value.
class Filler {
  public:
    template <class T>
    void operator()(std::string_view, T& value, std::string_view, std::string_view) {
        ++count_;
        if constexpr (std::is_same_v<T, std::string>) {
            value = "text, \"" + number_text(count_) + "\"";
        } else if constexpr (std::is_same_v<T, bool>) {
            value = true;
        } else if constexpr (std::is_enum_v<T>) {
            value = static_cast<T>(enum_names(value).size() - 1);
        } else if constexpr (std::is_integral_v<T>) {
            value = static_cast<T>(count_);
        } else {
            value = 0.125 * count_;
        }
    }

  private:
    int count_ = 0;
};

template <class Row>
class RowTest : public ::testing::Test {};
using Rows =
    ::testing::Types<TrialRow, AskedRow, LiftRow, EpisodeRow, PhaseRow, EventRow, ProcedureRow>;
TYPED_TEST_SUITE(RowTest, Rows);

TYPED_TEST(RowTest, IsReadAsItWasWritten) {
    const testing::TemporaryFolder folder;
    std::vector<TypeParam> rows(2);
    Filler filler;
    TypeParam::visit(rows[1], filler);
    const Table written = figure_table<TypeParam>(rows);
    write_csv(written, folder.file("table.csv"));
    const RowFile<TypeParam> read(folder.file("table.csv"));
    ASSERT_EQ(read.size(), 2u);
    const Table again = figure_table<TypeParam>(read);
    for (size_t row = 0; row < 2; ++row) {
        for (size_t i = 0; i < written.columns.size(); ++i) {
            const Table::Cell &a = written.rows[row][i], &b = again.rows[row][i];
            const auto* number = std::get_if<double>(&a);
            if (number == nullptr || std::isnan(*number)) {
                EXPECT_EQ(to_csv(a), to_csv(b)) << written.columns[i].name;
            } else {
                constexpr double kDigits = 1e-8;  // numbers in tables have nine digits
                EXPECT_NEAR(*number, std::get<double>(b), kDigits * std::abs(*number))
                    << written.columns[i].name;
            }
        }
    }
}

TEST(RowFile, LeavesOutWhatAnEarlierVersionDidNotWrite) {
    const testing::TemporaryFolder folder;
    const TrialFile trials(
        folder.write("trials.csv", "hand_angle_deg,trial_num,share\n90,7,\n,x,0.5\n"));
    EXPECT_EQ(trials[0].measures.hand_angle_deg, 90);
    EXPECT_EQ(trials[0].asked.trial, 7);
    EXPECT_TRUE(std::isnan(trials[0].asked.share));
    EXPECT_EQ(trials[0].asked.kind, TrialKind::baseline);
    EXPECT_TRUE(std::isnan(trials[1].measures.hand_angle_deg));
    EXPECT_EQ(trials[1].asked.trial, 0);  // the cell does not contain a number
    EXPECT_EQ(trials[1].asked.share, 0.5);
}

TEST(RowFile, AWholeNumberThatIsTooLargeIsNone) {
    const testing::TemporaryFolder folder;
    const RowFile<AskedRow> rows(
        folder.write("t.csv", "trial_num\n7\n-7.9\nnan\ninf\n1e10\n-1e10\n"));
    std::vector<int> numbers;
    for (const AskedRow& row : rows) numbers.push_back(row.trial);
    EXPECT_EQ(numbers, (std::vector<int>{7, -7, 0, 0, 0, 0}));
}

TEST(RowFile, KeepsFurtherColumns) {
    const testing::TemporaryFolder folder;
    const TrialFile trials(folder.write("trials.csv", "trial_num,squeeze_N\n1,2.5\n2,\n3\n"));
    const auto squeeze = trials.column("squeeze_N");
    ASSERT_TRUE(squeeze);
    EXPECT_EQ(trials.number(0, squeeze), 2.5);
    EXPECT_TRUE(std::isnan(trials.number(1, squeeze)));
    EXPECT_EQ(trials.text(2, squeeze), "");  // the line was cut off before this cell
    EXPECT_FALSE(trials.column("squeeze_mN"));
    EXPECT_TRUE(std::isnan(trials.number(0, trials.column("squeeze_mN"))));
}

TEST(RowFile, AWordThatAColumnCannotHaveIsAnErrorThatSaysWhere) {
    const testing::TemporaryFolder folder;
    try {
        const TrialFile trials(folder.write("trials.csv", "trial_num,kind\n1,catch\n2,cacth\n"));
        FAIL();
    } catch (const Error& e) {
        const Problem& problem = e.problems().front();
        EXPECT_EQ(problem.place.line, 3);
        EXPECT_EQ(problem.key, "kind");
        EXPECT_EQ(
            problem.what,
            "is 'cacth', which is not one of: practice, baseline, perturbed, catch, visual_clamp, "
            "force_channel, washout");
    }
}

TEST(RowFile, ReadsTheNamesOfEarlierVersions) {
    const testing::TemporaryFolder folder;
    const TrialFile trials(folder.write("trials.csv", "kind\nerror_clamp\n"));
    EXPECT_EQ(trials[0].asked.kind, TrialKind::visual_clamp);
    const LiftFile lifts =
        read_lifts(folder.write("lifts.csv", "coupling,coupling_lag_s\n0.9,0.01\n"));
    EXPECT_EQ(lifts[0].grip_load_r, 0.9);
    EXPECT_EQ(lifts[0].grip_load_lag, 0.01);
}

}  // namespace
}  // namespace dihaptic::rows::rows_test
