#include "player_icons.h"

#include <QPainter>

namespace dihaptic::gui {
namespace {

constexpr int kDrawn = 64;    // size at which an icon is drawn [px]
constexpr double kUnit = 16;  // size of an icon in the units below
constexpr double kUpper = 3, kLower = 13, kMiddle = 8;

/// A triangle with its tip to the right, or to the left if `tip` is smaller than `base`.
void draw_tip(QPainter& painter, double base, double tip) {
    painter.drawPolygon(QPolygonF{{base, kUpper}, {tip, kMiddle}, {base, kLower}});
}

void draw_bar(QPainter& painter, double left, double width) {
    painter.drawRect(QRectF(left, kUpper, width, kLower - kUpper));
}

/// Draws an icon that points to the right; those that point to the left are its mirror images.
void draw_icon(QPainter& painter, PlayerIcon icon) {
    switch (icon) {
        case PlayerIcon::play:
            return draw_tip(painter, 4, 13);
        case PlayerIcon::stop:
            draw_bar(painter, 4, 3);
            return draw_bar(painter, 9, 3);
        case PlayerIcon::previous_tick:
        case PlayerIcon::next_tick:
            draw_bar(painter, 4, 2);
            return draw_tip(painter, 8, 13);
        case PlayerIcon::previous_moment:
        case PlayerIcon::next_moment:
            draw_tip(painter, 2, 7);
            draw_tip(painter, 7, 12);
            return draw_bar(painter, 12, 2);
    }
}

}  // namespace

QIcon player_icon(PlayerIcon icon, const QPalette& palette) {
    QPixmap picture(kDrawn, kDrawn);
    picture.fill(Qt::transparent);
    QPainter painter(&picture);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.scale(kDrawn / kUnit, kDrawn / kUnit);
    if (icon == PlayerIcon::previous_moment || icon == PlayerIcon::previous_tick) {
        painter.translate(kUnit, 0);
        painter.scale(-1, 1);
    }
    painter.setPen(Qt::NoPen);
    painter.setBrush(palette.color(QPalette::ButtonText));
    draw_icon(painter, icon);
    return picture;
}

}  // namespace dihaptic::gui
