#include "start_page.h"

#include <QDir>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>
#include <vector>

#include "base/installed.h"
#include "edited_file.h"
#include "tile.h"

namespace dihaptic::gui {
namespace {

constexpr int kSearchWidth = 320;  // [px]

/// Files for a first session: a scene to play with, followed by a few files with trials.
const QStringList kFirst{"scenes/block-on-table.yaml", "experiments/first-trials.yaml",
                         "scenes/tools.yaml", "experiments/visuomotor-rotation.yaml"};

QStringList files_in(const QString& folder) {
    QStringList out;
    for (const QFileInfo& file : QDir(folder).entryInfoList({"*.yaml"}, QDir::Files, QDir::Name))
        out += QDir::cleanPath(file.filePath());
    return out;
}

/// The comment at the beginning of a file, up to the first line that is an empty comment or not a
/// comment. The line that tells editors the file's schema is left out.
QString head_of(const QString& file) {
    QStringList lines;
    for (const QByteArray& bytes : bytes_of(file).value_or(QByteArray()).split('\n')) {
        const QString line = QString::fromUtf8(bytes).trimmed();
        if (line.startsWith("# yaml-language-server:")) continue;
        if (!line.startsWith("# ")) break;
        lines += line.mid(2);
    }
    return lines.join(" ");
}

/// A shipped file has the name that is used on the command line; any other, also that of its
/// folder, because the experiments of most studies have the same name.
QString name_of(const QString& file) {
    const QFileInfo info(file);
    const QFileInfo above(info.absolutePath());
    const bool shipped = QFileInfo(above.absolutePath()) == QFileInfo(StartPage::shipped_folder());
    return shipped ? info.completeBaseName() : above.fileName() + "/" + info.completeBaseName();
}

/// Whether the text contains each of the words.
bool contains_all(const QString& text, const QStringList& words) {
    return std::ranges::all_of(
        words, [&](const QString& word) { return text.contains(word, Qt::CaseInsensitive); });
}

}  // namespace

StartPage::StartPage(QWidget* parent)
    : QWidget(parent), words_(new QLineEdit), shown_(new QStackedWidget), tabs_(new QTabWidget) {
    begin_ = add_list(tr("&Begin"));
    experiments_ = add_list(tr("E&xperiments"));
    scenes_ = add_list(tr("S&cenes"));
    recent_ = add_list(tr("Rece&nt"));
    found_ = make_list(tr("Found"));
    none_found_ = new QLabel;
    none_found_->setAlignment(Qt::AlignCenter);
    none_found_->setWordWrap(true);
    for (QWidget* widget : std::initializer_list<QWidget*>{tabs_, found_, none_found_})
        shown_->addWidget(widget);
    auto* layout = new QVBoxLayout(this);
    layout->addWidget(make_heading());
    layout->addWidget(shown_, 1);
    layout->addWidget(make_buttons());
    setTabOrder(words_, tabs_);
    connect(words_, &QLineEdit::textChanged, this, &StartPage::search);
    connect(words_, &QLineEdit::returnPressed, this, [this] {
        if (shown_->currentWidget() == found_)
            Q_EMIT chosen(found_->currentItem()->data(TileRole::file).toString());
    });
    connect(&shelf_, &Shelf::told, this,
            [this](const QString& file, const QString& title, const QString& length) {
                each(file, [&](QListWidgetItem& item) { show_file(item, title, length); });
            });
    connect(&shelf_, &Shelf::cannot_draw, this, &StartPage::cannot_draw);
    connect(&shelf_, &Shelf::drawn, this, [this](const QString& file, const QString& picture) {
        const QPixmap drawn = tile_picture(picture, devicePixelRatioF());
        if (drawn.isNull()) return;
        each(file, [&](QListWidgetItem& item) { item.setData(Qt::DecorationRole, drawn); });
    });
}

QWidget* StartPage::make_heading() {
    auto* title = new QLabel(
        tr("<h1>Dihaptic</h1><p>Click a picture to open it, or choose one with the arrow keys and "
           "press Enter. Without devices, the mouse moves the hand.</p>"));
    title->setWordWrap(true);
    words_->setPlaceholderText(tr("Search names and descriptions (Ctrl+F)"));
    words_->setAccessibleName(tr("Search"));
    words_->setClearButtonEnabled(true);
    words_->setFixedWidth(kSearchWidth);
    auto* heading = new QWidget;
    auto* layout = new QHBoxLayout(heading);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(title, 1);
    layout->addWidget(words_, 0, Qt::AlignBottom);
    return heading;
}

QWidget* StartPage::make_buttons() {
    auto* row = new QWidget;
    auto* layout = new QHBoxLayout(row);
    layout->setContentsMargins(0, 0, 0, 0);
    const auto add_button = [&](const QString& text, const QString& what, auto wanted) {
        auto* button = new QPushButton(text);
        button->setToolTip(what);
        connect(button, &QPushButton::clicked, this, wanted);
        layout->addWidget(button);
    };
    add_button(tr("Ne&w study ..."),
               tr("Makes a folder with a scene, a rig and an experiment, to be changed into yours"),
               &StartPage::new_study_requested);
    add_button(tr("&Open another file ..."), tr("Any scene or experiment on this computer"),
               &StartPage::open_requested);
    add_button(tr("&Recorded sessions ..."), tr("Looks at a session that was recorded"),
               &StartPage::sessions_requested);
    layout->addStretch(1);
    return row;
}

QListWidget* StartPage::make_list(const QString& title) {
    auto* list = new QListWidget;
    list->setAccessibleName(QString(title).remove('&'));
    list->setViewMode(QListView::IconMode);
    list->setItemDelegate(new TileDelegate(list));
    list->setResizeMode(QListView::Adjust);
    list->setMovement(QListView::Static);
    list->setUniformItemSizes(true);
    list->setSpacing(2);
    list->setMouseTracking(true);  // a tile under the pointer has a faint frame
    connect(list, &QListWidget::itemActivated, this, [this](const QListWidgetItem* item) {
        Q_EMIT chosen(item->data(TileRole::file).toString());
    });
    // a single click opens the file, as on a web page
    connect(list, &QListWidget::itemClicked, this, [this](const QListWidgetItem* item) {
        Q_EMIT chosen(item->data(TileRole::file).toString());
    });
    return list;
}

QListWidget* StartPage::add_list(const QString& title) {
    QListWidget* list = make_list(title);
    tabs_->addTab(list, title);
    return list;
}

void StartPage::add(QListWidget* list, const QStringList& files) {
    const QPixmap none = sketch(palette(), devicePixelRatioF());
    for (const QString& file : files) {
        auto* item = new QListWidgetItem(list);
        const QString head = head_of(file);
        item->setData(TileRole::file, file);
        item->setData(TileRole::name, name_of(file));
        item->setData(TileRole::head, head);
        item->setData(Qt::DecorationRole, none);
        item->setToolTip(
            QString("<p>%1</p><p><i>%2</i></p>").arg(head.toHtmlEscaped(), file.toHtmlEscaped()));
        show_file(*item, "", "");
    }
    if (list->count() > 0) list->setCurrentRow(0);
}

void StartPage::show_file(QListWidgetItem& item, const QString& title, const QString& length) {
    const QString name = item.data(TileRole::name).toString();
    item.setData(TileRole::line, title);
    item.setData(TileRole::length, length);
    QStringList words{name, title, length};
    words.removeAll(QString());
    item.setText(words.join(", "));
}

void StartPage::search(const QString& typed) {
    const QStringList words = typed.split(' ', Qt::SkipEmptyParts);
    if (words.isEmpty()) return shown_->setCurrentWidget(tabs_);
    // those whose names contain the words come first
    std::vector<QListWidgetItem*> items;
    while (found_->count() > 0) items.push_back(found_->takeItem(0));
    const auto rank = [&](const QListWidgetItem* item) {
        const QString name = item->data(TileRole::name).toString();
        return std::pair(!contains_all(name, words), item->data(TileRole::place).toInt());
    };
    std::ranges::sort(items, {}, rank);
    int first = -1;
    for (QListWidgetItem* item : items) {
        const bool fits = contains_all(item->text() + item->data(TileRole::head).toString(), words);
        found_->addItem(item);
        item->setHidden(!fits);
        if (fits && first < 0) first = found_->row(item);
    }
    none_found_->setText(tr("No scene or experiment here contains \"%1\".").arg(typed.trimmed()));
    if (first < 0) return shown_->setCurrentWidget(none_found_);
    found_->setCurrentRow(first);
    shown_->setCurrentWidget(found_);
}

template <class F>
void StartPage::each(const QString& file, const F& f) {
    for (QListWidget* list : lists()) {
        for (int i = 0; i < list->count(); ++i) {
            if (list->item(i)->data(TileRole::file).toString() == file) f(*list->item(i));
        }
    }
}

QString StartPage::shipped_folder() {
    if (QFileInfo("scenes").isDir()) return ".";
    return QString::fromStdString(dihaptic::shipped_folder());
}

QStringList StartPage::recent_files() {
    QStringList out;
    for (const QString& file : QSettings().value("recent").toStringList()) {
        if (QFileInfo::exists(file)) out += file;
    }
    return out;
}

void StartPage::fill() {
    words_->clear();
    for (QListWidget* list : lists()) list->clear();
    const QString shipped = shipped_folder();
    QStringList first;
    for (const QString& file : kFirst) {
        const QString path = QDir::cleanPath(shipped + "/" + file);
        if (QFileInfo::exists(path)) first += path;
    }
    const QStringList experiments = files_in(shipped + "/experiments");
    const QStringList scenes = files_in(shipped + "/scenes");
    const QStringList recent = recent_files();
    add(begin_, first);
    add(experiments_, experiments);
    add(scenes_, scenes);
    add(recent_, recent);
    tabs_->setTabEnabled(tabs_->indexOf(recent_), !recent.isEmpty());
    QStringList all = first + recent + experiments + scenes;
    all.removeDuplicates();
    add(found_, all);
    for (int i = 0; i < found_->count(); ++i) found_->item(i)->setData(TileRole::place, i);
    shelf_.read(all);
    tabs_->currentWidget()->setFocus();
}

}  // namespace dihaptic::gui
