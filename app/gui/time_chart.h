// Curves over a stretch of a session's time, one row each, with a cursor at the displayed moment. A
// click moves to a moment, the wheel zooms, a double click shows all.
#pragma once

#include <QWidget>

#include "chart_painter.h"
#include "curve_reader.h"

namespace dihaptic::gui {

class TimeChart : public QWidget {
    Q_OBJECT

  public:
    explicit TimeChart(QWidget* parent = nullptr);

    /// The whole session [s]; all of it is shown.
    void set_session(double begin, double end);
    double begin() const { return begin_; }
    double end() const { return end_; }
    /// `begin` and `end`: limits of the curves' stretch. `share`: share of it that has been read.
    void set_curves(std::vector<RecordedCurve> curves, double begin, double end, double share);
    /// Values of the curves at the cursor, as text; empty if there is no cursor.
    void set_values(const QStringList& values);
    void set_moments(std::vector<double> times);
    /// The displayed moment [s]. If it is out of sight, the chart scrolls to it.
    void set_cursor(double time);

    QSize sizeHint() const override { return {900, 260}; }
    QSize minimumSizeHint() const override { return {300, 120}; }

  Q_SIGNALS:
    void moment_chosen(double time);
    void stretch_changed();

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;

  private:
    QRectF area() const;
    double time_at(double x) const;
    void show_stretch(double begin, double end);
    void draw_row(QPainter& painter, size_t row, const QRectF& in) const;
    void draw_times(const ChartPainter& chart) const;

    double first_ = 0, last_ = 1;  // start and end of the session [s]
    double begin_ = 0, end_ = 1;   // displayed stretch
    double cursor_ = 0;
    double share_ = 1;
    std::vector<RecordedCurve> curves_;
    double curves_begin_ = 0, curves_end_ = 1;
    QStringList values_;
    std::vector<double> moments_;
};

}  // namespace dihaptic::gui
