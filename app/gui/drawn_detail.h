// Chooses in how much detail the next picture is drawn. Without a graphics card, moving pictures
// have less of it, and once nothing moves any more, the last one is drawn again in full.
#pragma once

#include <QElapsedTimer>
#include <QTimer>
#include <functional>
#include <optional>

namespace dihaptic::gui {

class DrawnDetail {
  public:
    /// `draw` draws the picture again.
    explicit DrawnDetail(const std::function<void()>& draw);

    /// Sets whether all pictures are drawn in full; if this is never called, the renderer decides.
    void set_fine(bool fine) { fine_ = fine; }
    /// To be called when it is known that drawing is slow. Returns false if set_fine() has been
    /// called.
    bool draws_slowly();
    /// To be called for each new frame.
    void frame_came() { since_frame_.start(); }
    /// Returns the share of the pixels of the next picture in each direction.
    double next();

  private:
    std::optional<bool> fine_;
    QTimer still_;               // runs out when nothing has moved for a while
    QElapsedTimer since_frame_;  // since the last frame came
    bool is_still_ = false;      // whether the next picture shows what the last one showed
};

}  // namespace dihaptic::gui
