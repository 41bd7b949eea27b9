// Calibrates the rig from the window, and checks before a session that its calibration still holds.
#pragma once

#include <QPointer>
#include <QWidget>
#include <functional>
#include <vector>

#include "guide_dialog.h"
#include "rig/rig.h"

namespace dihaptic::gui {

class Calibrator : public QObject {
    Q_OBJECT

  public:
    /// Its dialogs are of this window.
    explicit Calibrator(QWidget* window) : QObject(window), window_(window) {}

    /// Asks at the end whether to store what was found.
    void calibrate(const QString& rig_file);
    /// For a session's start, in its thread: whether the calibration still holds, by what the
    /// person holds together; who may skip it. `ends`: whether the session is to end.
    std::function<std::vector<Problem>(devices::DeviceGroup&)> together_check(
        const rig::Rig& rig, const std::vector<std::string>& fingers,
        const std::function<bool()>& ends);
    /// The session has ended, and its check with it, wherever that was.
    void end_check();

  Q_SIGNALS:
    void logged(const QString& text, bool problem);
    void stored();

  private:
    void ask_to_store(const rig::Rig& rig, const rig::CalibrationResult& result,
                      const std::string& rig_file, const std::string& file);

    QWidget* window_;
    QPointer<GuideDialog> check_;  // of the session that starts
};

}  // namespace dihaptic::gui
