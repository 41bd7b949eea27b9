// Lists the recorded sessions in a folder, for viewing or for writing a note.
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
    /// `folder`: folder that contains the sessions' folders.
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
