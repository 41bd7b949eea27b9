// The page that is shown while no file is open: suggested and recently opened files, as pictures
// with names, titles and durations.
#pragma once

#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QStackedWidget>
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
    /// Moves the keyboard focus to the field for words to search.
    void find() { words_->setFocus(Qt::ShortcutFocusReason); }

    /// The folder that contains `scenes` and `experiments`: the working directory or, failing that,
    /// the program's own folder; "" if there is none.
    static QString shipped_folder();
    /// Recently opened files that still exist, most recent first.
    static QStringList recent_files();

  Q_SIGNALS:
    /// The reason why there are no pictures, with its remedy.
    void cannot_draw(const QString& why);
    void chosen(const QString& file);
    void open_requested();
    void new_study_requested();
    void sessions_requested();

  private:
    QWidget* make_heading();
    QWidget* make_buttons();
    QListWidget* make_list(const QString& title);
    QListWidget* add_list(const QString& title);
    void add(QListWidget* list, const QStringList& files);
    void show_file(QListWidgetItem& item, const QString& title, const QString& length);
    /// Shows the files that contain all typed words in their name, title or description.
    void search(const QString& words);
    /// Calls f for each item that represents this file.
    template <class F>
    void each(const QString& file, const F& f);
    QList<QListWidget*> lists() const { return {begin_, experiments_, scenes_, recent_, found_}; }

    QLineEdit* words_;
    QStackedWidget* shown_;  // the tabs, or what a search found
    QTabWidget* tabs_;
    QListWidget* begin_;
    QListWidget* experiments_;
    QListWidget* scenes_;
    QListWidget* recent_;
    QListWidget* found_;
    QLabel* none_found_;
    Shelf shelf_;
};

}  // namespace dihaptic::gui
