// Lists the recorded sessions in a folder, to be viewed or to get a note.
#pragma once

#include <QDialog>
#include <QFileInfo>
#include <QTimer>

class QLabel;
class QLineEdit;
class QPushButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace dihaptic::gui {

class Reporter;
class SignLabel;

class SessionsDialog : public QDialog {
    Q_OBJECT

  public:
    /// `folder`: the folder that contains the session folders.
    explicit SessionsDialog(const QString& folder, QWidget* parent = nullptr);
    /// Shows the list as a part of a window, which cannot be closed.
    void embed();
    /// Shows what the reporter does, and why it fails.
    void follow(const Reporter& reporter);

  Q_SIGNALS:
    /// The user chose to view these session folders.
    void chosen(const QStringList& folders);
    /// The user chose to see the report of the session in this folder.
    void report_requested(const QString& folder);

  private:
    void fill_one();
    void fit_columns();
    /// Shows only the sessions of participants whose identifiers contain what the user has typed.
    void filter(QTreeWidgetItem& item);
    /// Says why the list is empty, if it is.
    void show_whether_empty();
    /// Shows what to do about the current session, if anything is to be done.
    void show_advice();
    void choose();
    /// Asks for a note about a session, and stores it in the session's folder.
    void write_note();

    QLabel* where_;
    QLabel* advice_;
    SignLabel* report_sign_;  // how far the report is
    QLineEdit* participant_;
    QTreeWidget* list_;
    QPushButton* open_;
    QPushButton* note_;
    QPushButton* report_;
    QPushButton* close_;
    QString folder_;
    QFileInfoList waiting_;  // session folders that have not been listed yet
    QTimer filling_;
};

}  // namespace dihaptic::gui
