// Tests what the trials panel shows of attempts and, a moment later, of their measures.
#include "trials_panel.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QHeaderView>

#include "session/plan.h"

namespace dihaptic::gui {
namespace {

class TrialsPanelTest : public ::testing::Test {
  protected:
    TrialsPanelTest() {
        session::Request request;
        request.file = "experiments/visuomotor-rotation.yaml";
        request.participant = "S07";
        panel_.set_plan(session::make_plan(request).task);
    }
    void end(int trial, int attempt) {
        session::TrialEnd end;
        end.trial = trial;
        end.attempt = attempt;
        end.start = trial;
        end.stop = trial + 0.5;
        panel_.add(end);
    }
    QTreeWidget& table() const { return *panel_.findChild<QTreeWidget*>(); }
    /// The text of a row in the column with this name; "hidden" if the column is hidden.
    std::string text(int row, const char* name) const {
        for (int i = 0; i < table().columnCount(); ++i) {
            if (table().headerItem()->text(i) != name) continue;
            return table().isColumnHidden(i) ? "hidden"
                                             : table().topLevelItem(row)->text(i).toStdString();
        }
        return "no column";
    }

    int count_ = 1;
    char name_[5] = "test";
    char* names_[2] = {name_, nullptr};
    const bool offscreen_ = qputenv("QT_QPA_PLATFORM", "offscreen");
    QApplication application_{count_, names_};
    TrialsPanel panel_;
};

TEST_F(TrialsPanelTest, ShowsWhatIsMeasuredOnceItIsFound) {
    end(1, 1);
    end(1, 2);
    EXPECT_EQ(text(0, "hand angle [deg]"), "no column");
    const Table::Cell none = kUnmeasured;
    Table found;
    for (const char* name : {"start_time", "trial_num", "attempt", "outcome", "peak_grip_N",
                             "peak_force_N", "hand_angle_deg", "shown_extent_mm", "not_measured"})
        found.columns.push_back({name, "meaning"});
    found.rows = {{0.0, 1.0, 1.0, "too slow", none, 1.0, none, none, ""},
                  {2.0, 1.0, 2.0, "reached", none, 1.0, -12.25, none, ""},
                  {4.0, 2.0, 1.0, "interrupted", none, 1.0, 3.5, none, ""}};
    panel_.set_figures(found);
    EXPECT_EQ(text(0, "hand angle [deg]"), "");
    EXPECT_EQ(text(1, "hand angle [deg]"), "-12.25");
    EXPECT_EQ(text(1, "shown extent [mm]"), "hidden");
    EXPECT_EQ(text(1, "not measured"), "hidden");
    EXPECT_EQ(text(1, "peak_grip_N"), "no column");
    end(2, 1);  // its measures were found before the attempt ended
    EXPECT_EQ(text(2, "hand angle [deg]"), "3.5");
    end(3, 1);
    EXPECT_EQ(text(3, "hand angle [deg]"), "");
    panel_.set_plan(nullptr);
    EXPECT_EQ(text(0, "hand angle [deg]"), "no column");
}

TEST_F(TrialsPanelTest, PutsMeasuresFirstAndHidesWhatSaysNothing) {
    end(1, 1);
    EXPECT_EQ(text(0, "peak grip [N]"), "hidden") << "it is always 0";
    EXPECT_EQ(text(0, "attempt"), "hidden") << "there has been only one for each trial";
    end(1, 2);
    EXPECT_EQ(text(0, "attempt"), "1");
    Table found;
    for (const char* name : {"trial_num", "attempt", "peak_force_N", "hand_angle_deg"})
        found.columns.push_back({name, "meaning"});
    found.rows = {{1.0, 1.0, 1.0, 2.5}, {1.0, 2.0, 1.0, -12.25}};
    panel_.set_figures(found);
    const QHeaderView& header = *table().header();
    const auto place = [&](const char* name) {
        for (int i = 0; i < table().columnCount(); ++i) {
            if (table().headerItem()->text(i) == name) return header.visualIndex(i);
        }
        return -1;
    };
    EXPECT_EQ(place("hand angle [deg]"), place("outcome") + 1);
    EXPECT_GT(place("duration [s]"), place("hand angle [deg]"));
    EXPECT_TRUE(
        table().headerItem()->toolTip(table().columnCount() - 1).contains("hand_angle_deg"));
    for (int i = 0; i < table().columnCount(); ++i) {
        if (table().isColumnHidden(i)) continue;
        const QFontMetrics metrics(table().font());
        EXPECT_GE(table().columnWidth(i),
                  metrics.horizontalAdvance(table().topLevelItem(1)->text(i)))
            << table().headerItem()->text(i).toStdString();
    }
}

TEST_F(TrialsPanelTest, TakesATableThatSaysNothing) {
    end(1, 1);
    panel_.set_figures({});
    Table other;
    other.columns = {{"trial_num", ""}};
    other.rows = {{1.0}};
    panel_.set_figures(other);
    EXPECT_EQ(table().topLevelItemCount(), 1);
}

}  // namespace
}  // namespace dihaptic::gui
