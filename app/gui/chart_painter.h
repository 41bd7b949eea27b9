// Shared by all charts: readable scales, axes with ticks, curves and legends.
#pragma once

#include <QPainter>
#include <QWidget>
#include <vector>

namespace dihaptic::gui {

/// The smallest of the numbers ..., 1, 2, 5, 10, 20, 50, ... that is not below `least`.
double round_step(double least);

/// The lowest and the highest line of a scale, and the distance between lines.
struct Scale {
    double low, high, step;
};

/// The scale for values from `low` to `high`, with approximately `lines` steps.
Scale scale_of(double low, double high, double lines);

/// Paints a chart into a rectangle of a widget. Across the rectangle, x goes from `begin` to `end`.
class ChartPainter {
  public:
    struct Entry {
        QString name;
        QColor colour;
    };
    enum class Mark { line, dot };
    static constexpr double kDot = 3;  ///< radius of a dot [pixels]

    ChartPainter(QPainter& painter, const QWidget& widget, const QRectF& area, double begin,
                 double end, const Scale& scale)
        : painter_(painter),
          widget_(widget),
          area_(area),
          begin_(begin),
          end_(end),
          scale_(scale) {}

    double x(double where) const {
        return area_.left() + (where - begin_) / (end_ - begin_) * area_.width();
    }
    double y(double value) const {
        return area_.bottom() - (value - scale_.low) / (scale_.high - scale_.low) * area_.height();
    }
    QPointF at(const QPointF& point) const { return {x(point.x()), y(point.y())}; }
    /// The text colour.
    QColor ink(int alpha = 255) const;
    /// Draws the lines of the scale and their numbers. `decimals`: number of decimals; -1 for as
    /// many as necessary.
    void draw_values(int decimals = -1) const;
    /// Writes a text below the chart. `lined`: whether to draw a faint vertical line up through the
    /// chart.
    void draw_tick(double where, const QString& text, bool lined = false) const;
    void draw_upright(double where, const QPen& pen) const;
    /// Joins points given in the chart's units; a NaN leaves a gap.
    void draw_curve(const std::vector<QPointF>& points, const QPen& pen) const;
    /// Draws a dot. `centre` is given in the widget's units.
    void draw_dot(const QPointF& centre, const QColor& colour) const;
    void draw_legend(double left, double top, const std::vector<Entry>& entries, Mark mark) const;
    /// Width of a legend that names lines [pixels].
    static double legend_width(const QFontMetrics& metrics, const std::vector<Entry>& entries);

  private:
    QPainter& painter_;
    const QWidget& widget_;
    QRectF area_;
    double begin_, end_;
    Scale scale_;
};

}  // namespace dihaptic::gui
