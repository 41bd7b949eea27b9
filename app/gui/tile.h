// Draws the tiles of the start page: a picture with a name, a line about the content, and the
// length. A tile whose picture is missing shows a sketch.
#pragma once

#include <QPixmap>
#include <QStyledItemDelegate>

namespace dihaptic::gui {

/// What an item of the page's lists holds, besides its text, which screen readers read.
struct TileRole {
    /// `place`: the tile's number in an unsorted list
    enum { file = Qt::UserRole, name, line, length, head, place };
};

/// Size of a tile's picture.
constexpr QSize kTilePicture{224, 140};

class TileDelegate : public QStyledItemDelegate {
    Q_OBJECT

  public:
    using QStyledItemDelegate::QStyledItemDelegate;

    void paint(QPainter* painter, const QStyleOptionViewItem& option,
               const QModelIndex& index) const override;
    QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override;
};

/// A sketch of a scene, in shades of the theme, for a file that has no picture.
QPixmap sketch(const QPalette& palette, double pixel_ratio);

/// The picture as a tile shows it, without a loss of sharpness on a fine display.
QPixmap tile_picture(const QString& file, double pixel_ratio);

}  // namespace dihaptic::gui
