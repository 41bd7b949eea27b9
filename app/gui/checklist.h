// The checklist before a session: the state of devices, calibration, displays, rights and disk,
// with a button for each remedy.
#pragma once

#include <QDialog>
#include <QGridLayout>

#include "session/readiness.h"

namespace dihaptic::gui {

class Checklist : public QDialog {
    Q_OBJECT

  public:
    /// `before_start`: accepting it starts the session; otherwise it is only shown.
    Checklist(const std::vector<session::Finding>& findings, bool before_start, QWidget* parent);

  Q_SIGNALS:
    /// A remedy's button was pressed; the dialog is closed.
    void chosen(dihaptic::session::Remedy remedy);

  private:
    void add(QGridLayout& rows, const session::Finding& finding);
};

}  // namespace dihaptic::gui
