// Makes a video of a part of a recorded session, as the player shows it.
#pragma once

#include <QString>
#include <functional>

class QOpenGLWidget;
class QWidget;

namespace dihaptic::gui {

struct Film {
    QString file;
    double begin = 0, end = 0;         ///< start and end of the recorded part [s]
    double speed = 1;                  ///< ratio of session time to video time
    std::function<void(double)> show;  ///< shows the session at a given time [s]
};

/// Makes the video while the window shows a progress bar with which the user can cancel it. Returns
/// whether the video was completed. Throws Error when this fails, for instance because ffmpeg is
/// missing.
bool make_film(const Film& film, QOpenGLWidget& view, QWidget* parent);

}  // namespace dihaptic::gui
