// The checklist before a session: what is found of devices, calibration, displays, rights and disk,
// with a button for what can be done about it.
#pragma once

#include <QDialog>
#include <QGridLayout>

#include "session/readiness.h"

namespace dihaptic::gui {

class Checklist : public QDialog {
    Q_OBJECT

  public:
    /// `before_start`: accepting it starts the session; otherwise it is only looked at.
    Checklist(const std::vector<session::Finding>& findings, bool before_start, QWidget* parent);

  Q_SIGNALS:
    /// A remedy's button was pressed; the dialog is closed.
    void chosen(dihaptic::session::Remedy remedy);

  private:
    void add(QGridLayout& rows, const session::Finding& finding);
};

}  // namespace dihaptic::gui
