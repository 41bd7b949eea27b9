// Calibrates a rig and registers its displays from the operator's window, and checks before a
// session that the calibration is still valid.
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
    /// `window`: parent of the dialogs.
    explicit Calibrator(QWidget* window) : QObject(window), window_(window) {}

    /// Calibrates a rig, then asks whether to store the result. `named_by`: the source of the rig
    /// file's name.
    void calibrate(const QString& rig_file, rig::NamedBy named_by);
    /// Shows crosses on the rig's first display to be touched, then asks whether to store their
    /// measured positions.
    void register_display(const QString& rig_file, rig::NamedBy named_by);
    /// Returns a check for the start of a session, to be called in the session's thread. In the
    /// check, the person holds the endpoints together or skips the step; if the calibration is no
    /// longer valid, the check returns warnings. `ends`: tells whether the session should end.
    std::function<std::vector<Problem>(devices::DeviceGroup&)> together_check(
        const rig::Rig& rig, const std::vector<std::string>& fingers,
        const std::function<bool()>& ends);
    /// To be called when the session has ended: ends the check of that session, whatever its state.
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
    QPointer<GuideDialog> check_;  // dialog of the check before the session that is starting
};

}  // namespace dihaptic::gui
