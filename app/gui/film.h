// Makes a video of a stretch of a recorded session, as the player shows it.
#pragma once

#include <QString>
#include <functional>

class QOpenGLWidget;
class QWidget;

namespace dihaptic::gui {

struct Film {
    QString file;
    double begin = 0, end = 0;         ///< stretch of the session [s]
    double speed = 1;                  ///< session time over video time
    std::function<void(double)> show;  ///< shows a moment [s]
};

/// Makes the video while its window waits, with a progress bar that can cancel it. Returns whether
/// it was completed. Throws Error when this fails, for instance because ffmpeg is missing.
bool make_film(const Film& film, QOpenGLWidget& view, QWidget* parent);

}  // namespace dihaptic::gui
