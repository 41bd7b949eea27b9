// Tests that curves of one unit share an axis, and that figures are saved as what their names say.
#include "time_chart.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QFile>
#include <QImage>

#include "saved_curves.h"
#include "testing/files.h"

namespace dihaptic::gui::time_chart_test {
namespace {

RecordedCurve curve(const char* name, const char* unit, float value) {
    return {name, unit, std::vector<float>(4, value), std::vector<float>(4, value)};
}

QByteArray saved(const TimeChart& chart, const char* name) {
    const testing::TemporaryFolder folder;
    const QString file = QString::fromStdString(folder.file(name));
    save_figure(chart, file);
    QFile written(file);
    EXPECT_TRUE(written.open(QIODevice::ReadOnly));
    return written.readAll();
}

class TimeChartTest : public ::testing::Test {
  protected:
    TimeChartTest() : application_(count_, names_) {
        chart_.resize(600, 300);
        chart_.set_session(0, 2);
        chart_.set_curves(
            {curve("grip_force", "N", 3), curve("block.z", "mm", 40), curve("load_force", "N", 1)},
            0, 2, 1);
    }

    int count_ = 1;
    char name_[5] = "test";
    char* names_[2] = {name_, nullptr};
    bool offscreen_ = qputenv("QT_QPA_PLATFORM", "offscreen");
    QApplication application_;
    TimeChart chart_;
};

TEST_F(TimeChartTest, SavesFiguresOfEachKind) {
    const QByteArray svg = saved(chart_, "curves.svg");
    EXPECT_TRUE(svg.contains("<svg"));
    for (const char* text : {"grip_force [N]", "block.z [mm]", "load_force [N]"})
        EXPECT_TRUE(svg.contains(text)) << text;
    EXPECT_TRUE(saved(chart_, "curves.pdf").startsWith("%PDF"));
    const QImage png = QImage::fromData(saved(chart_, "curves.png"));
    EXPECT_EQ(png.size(), QSize(1800, 900));
    EXPECT_EQ(png.pixelColor(2, 2), QColor(Qt::white));
}

TEST_F(TimeChartTest, GivesCurvesOfOneUnitOneAxis) {
    // the first line of each axis is its zero
    EXPECT_EQ(saved(chart_, "curves.svg").count(">0</text>"), 2);
}

TEST_F(TimeChartTest, RefusesAnotherKindOfFigure) {
    const testing::TemporaryFolder folder;
    EXPECT_THROW(save_figure(chart_, QString::fromStdString(folder.file("curves.bmp"))), Error);
}

}  // namespace
}  // namespace dihaptic::gui::time_chart_test
