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
    /// `name`: name of the plotted number, with its unit. `outcomes`: names of the outcomes, for
    /// the legend.
    void set_points(const QString& name, const QStringList& outcomes, std::vector<Point> points);

    QSize sizeHint() const override { return {320, 150}; }
    QSize minimumSizeHint() const override { return {160, 90}; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    std::vector<ChartPainter::Entry> legend() const;
    void draw_points(const ChartPainter& chart) const;

    QString name_;
    QStringList outcomes_;
    std::vector<Point> points_;
};

}  // namespace dihaptic::gui
