// What the window shows while no file is open: what there is to begin with, as pictures with titles
// and lengths, and what was open before.
#pragma once

#include <QListWidget>
#include <QTabWidget>
#include <QWidget>

#include "shelf.h"

namespace dihaptic::gui {

class StartPage : public QWidget {
    Q_OBJECT

  public:
    explicit StartPage(QWidget* parent = nullptr);

    /// Reads what there is again.
    void fill();
    /// Leaves the computer to what is opened.
    void rest() { shelf_.stop(); }

    /// The folder that `scenes` and `experiments` are in: the working directory, or else that of
    /// what comes with the program; "" if they are nowhere.
    static QString shipped_folder();
    /// Files that were opened before, the last one first, as long as they exist.
    static QStringList recent_files();

  Q_SIGNALS:
    void chosen(const QString& file);
    void open_requested();
    void sessions_requested();

  private:
    QListWidget* add_list(const QString& title);
    void add(QListWidget* list, const QStringList& files);
    /// Calls f on each item that shows the file.
    template <class F>
    void each(const QString& file, const F& f);

    QTabWidget* tabs_;
    QListWidget* begin_;
    QListWidget* experiments_;
    QListWidget* scenes_;
    QListWidget* recent_;
    Shelf shelf_;
};

}  // namespace dihaptic::gui
