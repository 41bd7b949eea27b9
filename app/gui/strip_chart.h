// A strip chart that shows the last seconds of one or more curves on a common scale.
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
    /// `unit`: common unit of the curves. `least_range`: smallest range of the scale.
    StripChart(QString title, QString unit, std::vector<Curve> curves, double least_range,
               QWidget* parent = nullptr);

    /// Adds one value for each curve at `time` [s]; NaN leaves a gap. If the time is earlier than
    /// the previous one, the chart restarts.
    void add(double time, const std::vector<double>& values);
    void clear();

    QSize sizeHint() const override { return {320, 150}; }
    QSize minimumSizeHint() const override { return {160, 150}; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    struct Sample {
        double time;
        std::vector<double> values;
    };
    /// The scale, with approximately `lines` steps.
    Scale range(int lines) const;

    QString title_;
    QString unit_;
    std::vector<Curve> curves_;
    double least_range_;
    std::deque<Sample> samples_;
};

}  // namespace dihaptic::gui
