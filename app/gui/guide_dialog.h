// The dialog that guides a person through a calibration or its check (rig/calibration_guide.h): it
// shows the current step and the progress. The work runs in another thread.
#pragma once

#include <QDialog>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <atomic>
#include <thread>

#include "rig/calibration_guide.h"

namespace dihaptic::gui {

class GuideDialog : public QDialog {
    Q_OBJECT

  public:
    /// `leave`: label of the button that gives up. The dialog is accepted when `work` is done, and
    /// rejected when the person gave up or closed the dialog after failed().
    GuideDialog(const QString& title, const QString& leave,
                std::function<void(const rig::Guide&)> work, QWidget* parent);
    /// Makes a dialog for work that another thread does with guide() and ends with finish(). The
    /// dialog must outlive that work.
    GuideDialog(const QString& title, const QString& leave, QWidget* parent);
    /// Cancels the work that the dialog itself runs, and waits until it ends.
    ~GuideDialog() override;

    void reject() override;

    /// The guide to be used by the working thread.
    rig::Guide guide();
    /// To be called from any thread when the work ends. `why`: reason of a failure. Only the first
    /// call has an effect.
    enum class Outcome { done, given_up, failed };
    void finish(Outcome outcome, const QString& why = "");

  Q_SIGNALS:
    void failed(const QString& why);

  private:
    void work();
    void show_guidance(const rig::Guidance& now);
    void end(Outcome outcome, const QString& why);

    std::function<void(const rig::Guide&)> work_;
    QLabel* step_;
    QLabel* text_;
    QLabel* measured_;
    QProgressBar* progress_;
    QPushButton* done_;
    QPushButton* leave_;
    std::atomic<bool> said_{false};
    std::atomic<bool> given_up_{false};
    bool ended_ = false;
    std::thread thread_;
};

}  // namespace dihaptic::gui
