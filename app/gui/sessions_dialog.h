// Lists the recorded sessions of a folder, to view one again or to write a note about it.
#pragma once

#include <QDialog>
#include <QFileInfo>
#include <QTimer>

class QPushButton;
class QTreeWidget;
class QTreeWidgetItem;

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
    void fill_one();
    void fit_columns();
    void choose();
    /// Asks for a note about a session, which is kept in its folder.
    void write_note();

    QTreeWidget* list_;
    QPushButton* open_;
    QPushButton* note_;
    QFileInfoList waiting_;  // folders not yet listed
    QTimer filling_;
};

}  // namespace dihaptic::gui
