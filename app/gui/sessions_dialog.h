// Lists the recorded sessions of a folder, to look at one again.
#pragma once

#include <QDialog>

class QTreeWidget;

namespace dihaptic::gui {

class SessionsDialog : public QDialog {
    Q_OBJECT

  public:
    /// `folder`: that holds the sessions' folders.
    explicit SessionsDialog(const QString& folder, QWidget* parent = nullptr);

  Q_SIGNALS:
    /// Folders of sessions.
    void chosen(const QStringList& folders);

  private:
    void fill(const QString& folder);
    void choose();

    QTreeWidget* list_;
};

}  // namespace dihaptic::gui
