// A chart of curves over part of a session, one curve per row, with a cursor at the displayed time.
// Clicking moves to a time, the wheel zooms, and double-clicking shows the whole session.
#pragma once

#include <QWidget>
#include <memory>

#include "chart_painter.h"
#include "curve_reader.h"

namespace dihaptic::gui {

class TimeChart : public QWidget {
    Q_OBJECT

  public:
    explicit TimeChart(QWidget* parent = nullptr);

    /// Sets the start and end of the session [s], and shows all of it.
    void set_session(double begin, double end);
    double begin() const { return begin_; }
    double end() const { return end_; }
    /// `begin` and `end`: the interval for which the curves were read. `share`: the share of the
    /// interval that has been read so far.
    void set_curves(std::vector<RecordedCurve> curves, double begin, double end, double share);
    /// Sets the values of the curves at the cursor, as text; empty if there is no cursor.
    void set_values(const QStringList& values);
    void set_moments(std::vector<double> times);
    /// Returns a chart of the same curves that can be saved.
    std::unique_ptr<TimeChart> on_paper() const;
    /// Sets the displayed time [s]. If it is out of view, the chart scrolls to it.
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
    /// The curves of each row: those that have the same unit share an axis.
    std::vector<std::vector<size_t>> rows() const;
    std::vector<QPointF> points_of(const RecordedCurve& curve) const;
    void draw_row(QPainter& painter, const std::vector<size_t>& curves, const QRectF& in) const;
    void draw_names(QPainter& painter, const std::vector<size_t>& curves, const QRectF& in) const;
    void draw_times(const ChartPainter& chart) const;

    double first_ = 0, last_ = 1;  // start and end of the session [s]
    double begin_ = 0, end_ = 1;   // displayed stretch
    double cursor_ = 0;
    double share_ = 1;
    bool on_paper_ = false;
    std::vector<RecordedCurve> curves_;
    double curves_begin_ = 0, curves_end_ = 1;
    QStringList values_;
    std::vector<double> moments_;
};

}  // namespace dihaptic::gui
