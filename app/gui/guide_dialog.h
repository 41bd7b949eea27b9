// Leads a person through what a rig needs of one (rig/calibration_guide.h): what to do now, and how
// far that is. The work runs in another thread.
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
    /// `leave`: name of the button that gives up. It is accepted when `work` is done, and rejected
    /// when the person gave up, or after failed().
    GuideDialog(const QString& title, const QString& leave,
                std::function<void(const rig::Guide&)> work, QWidget* parent);
    /// The same of work that another does: with guide(), and finish() at its end. Outlives it.
    GuideDialog(const QString& title, const QString& leave, QWidget* parent);
    /// Gives up, and waits for the work's end.
    ~GuideDialog() override;

    void reject() override;

    /// For the thread that works.
    rig::Guide guide();
    /// From any thread: what came of it; `why`: it failed. The first counts.
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
