// Tests which plots a session has, and how high they are.
#include "plots_panel.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <set>

#include "column_words.h"
#include "trial_strip.h"

namespace dihaptic::gui {
namespace {

session::Plan plan_for(const char* file) {
    session::Request request;
    request.file = file;
    request.participant = "S07";
    return session::make_plan(request);
}

class PlotsPanelTest : public ::testing::Test {
  protected:
    int count_ = 1;
    char name_[5] = "test";
    char* names_[2] = {name_, nullptr};
    const bool offscreen_ = qputenv("QT_QPA_PLATFORM", "offscreen");
    QApplication application_{count_, names_};
};

TEST_F(PlotsPanelTest, TheTaskChoosesThem) {
    EXPECT_EQ(plot_kind(plan_for("experiments/visuomotor-rotation.yaml")), PlotKind::reach);
    EXPECT_EQ(plot_kind(plan_for("experiments/first-trials.yaml")), PlotKind::lift);
    EXPECT_EQ(plot_kind(plan_for("scenes/block-on-table.yaml")), PlotKind::lift);
    EXPECT_EQ(plot_kind(plan_for("experiments/grating-roughness.yaml")), PlotKind::threshold);
    EXPECT_EQ(plot_kind(plan_for("experiments/visual-scaling.yaml")), PlotKind::threshold)
        << "its procedures choose shares of perturbations";
}

TEST_F(PlotsPanelTest, AreHighEnoughToBeReadAndNamedInWords) {
    for (const char* file :
         {"experiments/visuomotor-rotation.yaml", "experiments/first-trials.yaml",
          "experiments/grating-roughness.yaml"}) {
        PlotsPanel panel;
        panel.set_plan(plan_for(file));
        panel.resize(380, 100);
        panel.show();
        int charts = 0;
        for (const QWidget* chart : panel.findChildren<QWidget*>()) {
            ++charts;
            EXPECT_GE(chart->minimumSizeHint().height(), 150) << file;
            EXPECT_FALSE(chart->accessibleName().isEmpty()) << file;
            EXPECT_FALSE(chart->accessibleName().contains('_')) << file;
        }
        EXPECT_GE(charts, 2) << file;
        EXPECT_GE(panel.minimumSizeHint().height(), 150 * charts) << file;
    }
}

TEST_F(PlotsPanelTest, ColumnsHaveNamesInWords) {
    EXPECT_EQ(column_words("hand_angle_deg"), "hand angle [deg]");
    EXPECT_EQ(column_words("peak_load_rate_N_s"), "peak load rate [N/s]");
    EXPECT_EQ(column_words("grip_load_r"), "grip load r");
    EXPECT_EQ(column_words("score"), "score");
}

TEST_F(PlotsPanelTest, OutcomesHaveColoursOfTheirOwn) {
    const session::Plan plan = plan_for("experiments/visuomotor-rotation.yaml");
    std::set<QString> colours;
    for (const ChartPainter::Entry& outcome : outcomes_of(*plan.task))
        EXPECT_TRUE(colours.insert(outcome.colour.name()).second) << outcome.name.toStdString();
    EXPECT_GE(colours.size(), 3u);
}

TEST_F(PlotsPanelTest, AStripShowsEachTrialsLastOutcome) {
    const session::Plan plan = plan_for("experiments/visuomotor-rotation.yaml");
    TrialStrip strip;
    strip.set_plan(plan.task);
    EXPECT_EQ(strip.count(0), 0);
    session::TrialEnd end;
    end.trial = 2;
    end.outcome = 1;
    strip.add(end);
    EXPECT_EQ(strip.count(1), 1);
    end.outcome = 0;  // the same trial, tried again
    strip.add(end);
    EXPECT_EQ(strip.count(1), 0);
    EXPECT_EQ(strip.count(0), 1);
    end.trial = 505;
    strip.add(end);
    EXPECT_EQ(strip.count(0), 1);
    strip.resize(340, strip.sizeHint().height());
    strip.set_current(3);
    strip.grab();  // draws
}

}  // namespace
}  // namespace dihaptic::gui
