// The page that is shown while no file is open: suggested and recently opened files, as pictures
// with titles and durations.
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

    /// Reads the files again and fills the page.
    void fill();
    /// Stops reading, so that the computer is free for the file that is being opened.
    void rest() { shelf_.stop(); }

    /// The folder that contains `scenes` and `experiments`: the working directory or, failing that,
    /// the program's own folder; "" if there is none.
    static QString shipped_folder();
    /// Recently opened files that still exist, most recent first.
    static QStringList recent_files();

  Q_SIGNALS:
    void chosen(const QString& file);
    void open_requested();
    void sessions_requested();

  private:
    QListWidget* add_list(const QString& title);
    void add(QListWidget* list, const QStringList& files);
    /// Calls f for each item that represents this file.
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
