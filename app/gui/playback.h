// Lets time pass while a recording is played, at a chosen speed.
#pragma once

#include <QElapsedTimer>
#include <QTimer>
#include <functional>

namespace dihaptic::gui {

class Playback {
  public:
    /// `pass` is called for each picture with the time that has passed in the recording [s].
    explicit Playback(const std::function<void(double)>& pass) {
        timer_.callOnTimeout([this, pass] {
            const double passed = speed_ * 1e-9 * static_cast<double>(since_.nsecsElapsed());
            since_.restart();
            pass(passed);
        });
    }

    bool plays() const { return timer_.isActive(); }
    void start() {
        constexpr int kPicture = 16;  // [ms]
        since_.start();
        timer_.start(kPicture);
    }
    void stop() { timer_.stop(); }
    /// Ratio of the recording's time to that of the clock on the wall.
    double speed() const { return speed_; }
    void set_speed(double speed) { speed_ = speed; }

  private:
    QTimer timer_;
    QElapsedTimer since_;
    double speed_ = 1;
};

}  // namespace dihaptic::gui
