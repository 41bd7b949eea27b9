// The checklist shown before a session: the state of devices, calibration, displays, rights and
// disk, with a button for each remedy.
#pragma once

#include <QDialog>
#include <QGridLayout>

#include "session/readiness.h"

namespace dihaptic::gui {

class Checklist : public QDialog {
    Q_OBJECT

  public:
    /// `before_start`: whether accepting the dialog starts the session; otherwise the checklist is
    /// for information only.
    Checklist(const std::vector<session::Finding>& findings, bool before_start, QWidget* parent);

  Q_SIGNALS:
    /// The button of a remedy was pressed, and the dialog is closed.
    void chosen(dihaptic::session::Remedy remedy);

  private:
    void add(QGridLayout& rows, const session::Finding& finding);
};

}  // namespace dihaptic::gui
