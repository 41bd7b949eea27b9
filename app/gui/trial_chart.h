// A chart of a number over trials: a staircase, or how a person learns.
#pragma once

#include <QWidget>
#include <vector>

#include "chart_painter.h"

namespace dihaptic::gui {

class TrialChart : public QWidget {
  public:
    explicit TrialChart(QWidget* parent = nullptr);

    struct Point {
        double value = 0;  ///< NaN: the trial has no value
        int outcome = 0;
        bool begins_block = false;
    };
    /// `name`: name of the number, with its unit. `outcomes`: names of outcomes, for the legend.
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
