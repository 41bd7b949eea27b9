// A chart that plots a number over trials, e.g. a staircase or a learning curve.
#pragma once

#include <QWidget>
#include <vector>

#include "chart_painter.h"

namespace dihaptic::gui {

class TrialChart : public QWidget {
  public:
    explicit TrialChart(QWidget* parent = nullptr);

    struct Point {
        double value = 0;  ///< NaN if the trial has no value
        int outcome = 0;
        bool begins_block = false;
    };
    /// `name`: name of the plotted number, with its unit.
    void set_points(const QString& name, std::vector<ChartPainter::Entry> outcomes,
                    std::vector<Point> points);

    QSize sizeHint() const override { return {320, 150}; }
    QSize minimumSizeHint() const override { return {160, 150}; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    std::vector<ChartPainter::Entry> legend() const;
    QColor colour_of(int outcome) const;
    void draw_points(const ChartPainter& chart) const;

    QString name_;
    std::vector<ChartPainter::Entry> outcomes_;
    std::vector<Point> points_;
};

}  // namespace dihaptic::gui
