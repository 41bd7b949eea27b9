#include "icons.h"

#include <QApplication>
#include <QIconEngine>
#include <QPainter>
#include <QPalette>
#include <QSvgRenderer>

namespace dihaptic::gui {
namespace {

void draw_shape(QPainter& painter, std::string_view shape, const QColor& colour,
                const QRectF& place) {
    QByteArray svg(shape.data(), static_cast<qsizetype>(shape.size()));
    svg.replace("#000000", colour.name().toLatin1());
    QSvgRenderer(svg).render(&painter, place);
}

/// Draws a shape whenever the icon is shown, in the theme's colour at that time.
class ShapeEngine : public QIconEngine {
  public:
    explicit ShapeEngine(std::string_view shape) : shape_(shape) {}
    QIconEngine* clone() const override { return new ShapeEngine(shape_); }
    void paint(QPainter* painter, const QRect& place, QIcon::Mode mode, QIcon::State) override {
        const auto group = mode == QIcon::Disabled ? QPalette::Disabled : QPalette::Active;
        draw_shape(*painter, shape_, QApplication::palette().color(group, QPalette::ButtonText),
                   place);
    }
    QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
        QPixmap out(size);
        out.fill(Qt::transparent);
        QPainter painter(&out);
        paint(&painter, {{0, 0}, size}, mode, state);
        return out;
    }

  private:
    std::string_view shape_;
};

}  // namespace

QIcon icon(std::string_view shape) {
    return QIcon(new ShapeEngine(shape));
}

QPixmap icon_picture(std::string_view shape, const QColor& colour, int size, double scale) {
    QPixmap out(QSize(size, size) * scale);
    out.setDevicePixelRatio(scale);
    out.fill(Qt::transparent);
    QPainter painter(&out);
    draw_shape(painter, shape, colour, QRectF(0, 0, size, size));
    return out;
}

}  // namespace dihaptic::gui
