// A chart of one quantity against another: a path seen from above, or grip against load.
#pragma once

#include <QWidget>
#include <vector>

#include "chart_painter.h"

namespace dihaptic::gui {

class PlaneChart : public QWidget {
  public:
    struct Line {
        std::vector<QPointF> points;  ///< NaN leaves a gap
        QColor colour;
        double width = 1.8;  ///< [pixels]
        QString name;        ///< in the legend; "" for none
    };
    struct Circle {
        QPointF centre;
        double radius = 0;
        QColor colour;
    };
    /// `least_range`: smallest range of each axis. `alike`: whether both axes have the same scale,
    /// as a map has.
    PlaneChart(double least_range, bool alike, QWidget* parent = nullptr);

    /// `title`: what is plotted, with the unit. `across`: name of the horizontal axis; "" for a
    /// map.
    void set_names(const QString& title, const QString& across);
    /// Sets the line of text below the title.
    void set_result(const QString& text);
    void set(std::vector<Line> lines, std::vector<Circle> circles = {});

    QSize sizeHint() const override { return {320, 220}; }
    QSize minimumSizeHint() const override { return {160, 150}; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    QRectF bounds() const;
    QRectF shown_bounds(const QRectF& area) const;
    int heading_lines() const;
    void draw_heading(const ChartPainter& chart, QPainter& painter, const QRectF& area) const;

    double least_range_;
    bool alike_;
    QString title_, across_, result_;
    std::vector<Line> lines_;
    std::vector<Circle> circles_;
};

}  // namespace dihaptic::gui
