#include "tile.h"

#include <QApplication>
#include <QPainter>
#include <QPainterPath>
#include <QTextLayout>

namespace dihaptic::gui {
namespace {

constexpr int kFrame = 3;     // width of the frame of the chosen tile [px]
constexpr int kPadding = 8;   // distance of the content from the tile's edge [px]
constexpr int kTextGap = 6;   // distance of the text from the picture [px]
constexpr int kLines = 2;     // lines of text below the name
constexpr double kRound = 5;  // radius of corners [px]

QColor mixed(const QColor& a, const QColor& b, double share) {
    const auto part = [&](int from, int to) {
        return static_cast<int>(std::lround(from + share * (to - from)));
    };
    return {part(a.red(), b.red()), part(a.green(), b.green()), part(a.blue(), b.blue())};
}

QFont name_font(const QFont& font) {
    QFont out = font;
    out.setBold(true);
    return out;
}

/// Draws text in at most kLines lines, of which the last is shortened if necessary.
void draw_lines(QPainter& painter, const QRectF& area, const QString& text) {
    QTextLayout layout(text, painter.font());
    const QFontMetrics metrics(painter.font());
    layout.beginLayout();
    for (int i = 0; i < kLines; ++i) {
        QTextLine line = layout.createLine();
        if (!line.isValid()) break;
        line.setLineWidth(area.width());
        const double top = area.top() + i * metrics.lineSpacing();
        const bool is_last = i + 1 == kLines;
        const QString rest = text.mid(line.textStart());
        const QString words =
            is_last ? metrics.elidedText(rest, Qt::ElideRight, static_cast<int>(area.width()))
                    : rest.left(line.textLength());
        painter.drawText(QPointF(area.left(), top + metrics.ascent()), words.trimmed());
    }
    layout.endLayout();
}

void draw_frame(QPainter& painter, const QStyleOptionViewItem& option) {
    const bool chosen = option.state.testFlag(QStyle::State_Selected);
    const bool pointed = option.state.testFlag(QStyle::State_MouseOver);
    if (!chosen && !pointed) return;
    QColor colour = option.palette.color(QPalette::Highlight);
    if (!chosen) colour.setAlpha(110);
    painter.setPen(QPen(colour, kFrame));
    painter.setBrush(Qt::NoBrush);
    const double half = kFrame / 2.0;
    painter.drawRoundedRect(QRectF(option.rect).adjusted(half, half, -half, -half), kRound, kRound);
}

void draw_texts(QPainter& painter, const QRectF& area, const QStyleOptionViewItem& option,
                const QModelIndex& index) {
    const QString length = index.data(TileRole::length).toString();
    const QColor ink = option.palette.color(QPalette::Text);
    const QColor faint = option.palette.color(QPalette::PlaceholderText);
    const QFontMetrics metrics(option.font);
    const int width = metrics.horizontalAdvance(length);
    painter.setFont(option.font);
    painter.setPen(faint);
    painter.drawText(area, Qt::AlignRight | Qt::AlignTop, length);
    painter.setFont(name_font(option.font));
    painter.setPen(ink);
    const int room = static_cast<int>(area.width()) - (length.isEmpty() ? 0 : width + kPadding);
    const QFontMetrics bold(painter.font());
    const QString name = index.data(TileRole::name).toString();
    painter.drawText(area, Qt::AlignLeft | Qt::AlignTop,
                     bold.elidedText(name, Qt::ElideMiddle, room));
    painter.setFont(option.font);
    draw_lines(painter, area.adjusted(0, bold.lineSpacing(), 0, 0),
               index.data(TileRole::line).toString());
}

}  // namespace

void TileDelegate::paint(QPainter* painter, const QStyleOptionViewItem& option,
                         const QModelIndex& index) const {
    painter->save();
    painter->setRenderHints(QPainter::Antialiasing | QPainter::SmoothPixmapTransform);
    draw_frame(*painter, option);
    const QRectF inside = QRectF(option.rect).adjusted(kPadding, kPadding, -kPadding, -kPadding);
    const QRectF picture(inside.center().x() - kTilePicture.width() / 2.0, inside.top(),
                         kTilePicture.width(), kTilePicture.height());
    QPainterPath rounded;
    rounded.addRoundedRect(picture, kRound, kRound);
    painter->setClipPath(rounded);
    painter->drawPixmap(picture.topLeft(), index.data(Qt::DecorationRole).value<QPixmap>());
    painter->setClipping(false);
    draw_texts(*painter,
               {picture.left(), picture.bottom() + kTextGap, picture.width(),
                inside.bottom() - picture.bottom() - kTextGap},
               option, index);
    painter->restore();
}

QSize TileDelegate::sizeHint(const QStyleOptionViewItem& option, const QModelIndex&) const {
    const int text = QFontMetrics(name_font(option.font)).lineSpacing() +
                     kLines * QFontMetrics(option.font).lineSpacing();
    return {kTilePicture.width() + 2 * kPadding,
            kTilePicture.height() + kTextGap + text + 2 * kPadding};
}

QPixmap sketch(const QPalette& palette, double pixel_ratio) {
    QPixmap out(kTilePicture * pixel_ratio);
    out.setDevicePixelRatio(pixel_ratio);
    const QColor ground = palette.color(QPalette::Window),
                 ink = palette.color(QPalette::WindowText);
    const auto shade = [&](double share) { return mixed(ground, ink, share); };
    QPainter painter(&out);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.fillRect(QRect(QPoint(), kTilePicture), shade(0.06));
    painter.setPen(QPen(shade(0.45), 1.5, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    const auto draw = [&](const QPolygonF& polygon, double share) {
        painter.setBrush(shade(share));
        painter.drawPolygon(polygon);
    };
    draw({{34, 116}, {70, 72}, {190, 72}, {206, 116}}, 0.12);  // a table
    draw({{90, 66}, {126, 66}, {126, 102}, {90, 102}}, 0.2);   // a block: its front, top and side
    draw({{90, 66}, {104, 54}, {140, 54}, {126, 66}}, 0.1);
    draw({{126, 66}, {140, 54}, {140, 88}, {126, 102}}, 0.3);
    painter.setBrush(shade(0.25));  // two fingers
    painter.drawEllipse(QPointF(76, 86), 8, 8);
    painter.drawEllipse(QPointF(154, 78), 8, 8);
    return out;
}

QPixmap tile_picture(const QString& file, double pixel_ratio) {
    QPixmap out(file);
    if (out.isNull()) return out;
    out = out.scaled(kTilePicture * pixel_ratio, Qt::KeepAspectRatioByExpanding,
                     Qt::SmoothTransformation);
    out.setDevicePixelRatio(pixel_ratio);
    return out;
}

}  // namespace dihaptic::gui
