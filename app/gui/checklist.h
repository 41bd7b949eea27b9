// What to check before a session, with the remedies: a panel, and a dialog that precedes sessions
// on real devices. The checks themselves are in session/readiness.h.
#pragma once

#include <QDialog>
#include <QVBoxLayout>
#include <vector>

#include "session/readiness.h"

namespace dihaptic::gui {

/// The list of checks, one below the other.
class ChecksView : public QWidget {
    Q_OBJECT

  public:
    explicit ChecksView(QWidget* parent = nullptr);
    void set(const std::vector<session::Finding>& findings);

  Q_SIGNALS:
    void chosen(dihaptic::session::Remedy remedy);

  private:
    void add(const session::Finding& finding);

    QVBoxLayout* rows_;
};

class Checklist : public QDialog {
    Q_OBJECT

  public:
    /// `before_start`: whether a session follows if the dialog is accepted.
    Checklist(const std::vector<session::Finding>& findings, bool before_start, QWidget* parent);

  Q_SIGNALS:
    void chosen(dihaptic::session::Remedy remedy);
};

}  // namespace dihaptic::gui
