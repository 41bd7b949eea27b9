// Calibrates a rig and registers its displays from the window, and checks before a session that the
// calibration is still valid.
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
    /// `window`: parent of its dialogs.
    explicit Calibrator(QWidget* window) : QObject(window), window_(window) {}

    /// At the end asks whether to store the result. `named_by`: who named the rig file.
    void calibrate(const QString& rig_file, rig::NamedBy named_by);
    /// Shows crosses on the rig's first display, and at the end asks whether to store their touched
    /// positions.
    void register_display(const QString& rig_file, rig::NamedBy named_by);
    /// Makes a check for the start of a session, to be called in the session's thread: the person
    /// holds endpoints together, or skips this, and the check returns warnings if the calibration
    /// is no longer valid. `ends`: whether the session should end.
    std::function<std::vector<Problem>(devices::DeviceGroup&)> together_check(
        const rig::Rig& rig, const std::vector<std::string>& fingers,
        const std::function<bool()>& ends);
    /// Call when the session has ended: ends its check, whatever its state.
    void end_check();

  Q_SIGNALS:
    void logged(const QString& text, bool problem);
    void stored();

  private:
    void ask_to_store(const rig::Rig& rig, const rig::CalibrationResult& result,
                      const std::string& rig_file, const std::string& file);
    void store(const rig::Rig& rig, const display::Display& display,
               const display::RegistrationResult& result, const std::string& rig_file);

    QWidget* window_;
    QPointer<GuideDialog> check_;  // dialog of the starting session's check
};

}  // namespace dihaptic::gui
