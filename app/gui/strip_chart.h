// A strip chart: one or more curves of the last seconds, on one scale.
#pragma once

#include <QWidget>
#include <deque>
#include <vector>

#include "chart_painter.h"

namespace dihaptic::gui {

class StripChart : public QWidget {
    Q_OBJECT

  public:
    static constexpr double kSeconds = 10;

    using Curve = ChartPainter::Entry;
    /// `unit`: unit of all curves. `least_range`: least range of the scale.
    StripChart(QString title, QString unit, std::vector<Curve> curves, double least_range,
               QWidget* parent = nullptr);

    /// Adds values at `time` [s], one for each curve; NaN leaves a gap. A time before the last one
    /// restarts the chart.
    void add(double time, const std::vector<double>& values);
    void clear();

    QSize sizeHint() const override { return {320, 150}; }
    QSize minimumSizeHint() const override { return {160, 70}; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    struct Sample {
        double time;
        std::vector<double> values;
    };
    /// Range of the scale. `lines`: approximate number of steps.
    Scale range(int lines) const;

    QString title_;
    QString unit_;
    std::vector<Curve> curves_;
    double least_range_;
    std::deque<Sample> samples_;
};

}  // namespace dihaptic::gui
