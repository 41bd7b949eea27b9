#include "film.h"

#include <QCoreApplication>
#include <QOpenGLWidget>
#include <QProgressDialog>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "view/movie.h"

namespace dihaptic::gui {
namespace {

constexpr int kRate = 30;  // pictures per second

/// The contents of a window, cropped to an even width and height, as required for videos.
Image picture_of(QOpenGLWidget& view, int width, int height) {
    const QImage all = view.grabFramebuffer().convertToFormat(QImage::Format_RGB888);
    Image out{width, height, {}};
    const size_t row = 3 * static_cast<size_t>(width);
    out.rgb.resize(row * static_cast<size_t>(height));
    for (int y = 0; y < std::min(height, all.height()); ++y) {
        std::memcpy(out.rgb.data() + row * static_cast<size_t>(y), all.constScanLine(y),
                    std::min(row, 3 * static_cast<size_t>(all.width())));
    }
    return out;
}

}  // namespace

bool make_film(const Film& film, QOpenGLWidget& view, QWidget* parent) {
    const auto pictures =
        1 + static_cast<int>(std::floor((film.end - film.begin) / film.speed * kRate + 1e-6));
    QProgressDialog told(QCoreApplication::translate("Film", "Making %1").arg(film.file),
                         QCoreApplication::translate("Film", "Cancel"), 0, pictures, parent);
    told.setWindowModality(Qt::WindowModal);
    told.setMinimumDuration(0);
    film.show(film.begin);
    const QSize size = view.grabFramebuffer().size();
    const int width = size.width() & ~1, height = size.height() & ~1;
    view::Movie movie(film.file.toStdString(), width, height, kRate);
    for (int i = 0; i < pictures; ++i) {
        told.setValue(i);  // also processes mouse clicks
        if (told.wasCanceled()) return false;
        film.show(film.begin + film.speed * i / kRate);
        movie.add(picture_of(view, width, height));
    }
    movie.finish();
    told.setValue(pictures);
    return true;
}

}  // namespace dihaptic::gui
