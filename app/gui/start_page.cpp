#include "start_page.h"

#include <QDir>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>

#include "base/installed.h"
#include "edited_file.h"

namespace dihaptic::gui {
namespace {

constexpr QSize kTileSize{224, 140};
constexpr QSize kItem{240, 200};  // size of an item: a picture with title and duration below it
constexpr int kFile = Qt::UserRole;

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
/// comment.
QString head_of(const QString& file) {
    QStringList lines;
    for (const QByteArray& bytes : bytes_of(file).value_or(QByteArray()).split('\n')) {
        const QString line = QString::fromUtf8(bytes).trimmed();
        if (!line.startsWith("# ")) break;
        lines += line.mid(2);
    }
    return lines.join(" ");
}

}  // namespace

StartPage::StartPage(QWidget* parent) : QWidget(parent), tabs_(new QTabWidget) {
    auto* title =
        new QLabel(tr("<h1>Dihaptic</h1><p>Choose a file to start with. Without devices, the mouse "
                      "moves the hand.</p>"));
    auto* open = new QPushButton(tr("&Open another file ..."));
    auto* sessions = new QPushButton(tr("&Recorded sessions ..."));
    begin_ = add_list(tr("&Begin"));
    experiments_ = add_list(tr("&Experiments"));
    scenes_ = add_list(tr("S&cenes"));
    recent_ = add_list(tr("Rece&nt"));
    auto* buttons = new QHBoxLayout;
    buttons->addWidget(open);
    buttons->addWidget(sessions);
    buttons->addStretch(1);
    auto* layout = new QVBoxLayout(this);
    layout->addWidget(title);
    layout->addWidget(tabs_, 1);
    layout->addLayout(buttons);
    connect(open, &QPushButton::clicked, this, &StartPage::open_requested);
    connect(sessions, &QPushButton::clicked, this, &StartPage::sessions_requested);
    connect(&shelf_, &Shelf::told, this,
            [this](const QString& file, const QString& name, const QString& length) {
                each(file, [&](QListWidgetItem& item) {
                    item.setText(length.isEmpty() ? name : name + "\n" + length);
                });
            });
    connect(&shelf_, &Shelf::drawn, this, [this](const QString& file, const QString& picture) {
        const QIcon icon(picture);
        each(file, [&](QListWidgetItem& item) { item.setIcon(icon); });
    });
}

QListWidget* StartPage::add_list(const QString& title) {
    auto* list = new QListWidget;
    list->setAccessibleName(QString(title).remove('&'));
    list->setViewMode(QListView::IconMode);
    list->setIconSize(kTileSize);
    list->setGridSize(kItem);
    list->setResizeMode(QListView::Adjust);
    list->setMovement(QListView::Static);
    list->setWordWrap(true);
    connect(list, &QListWidget::itemActivated, this,
            [this](const QListWidgetItem* item) { Q_EMIT chosen(item->data(kFile).toString()); });
    // a single click opens the file, as on a web page
    connect(list, &QListWidget::itemClicked, this,
            [this](const QListWidgetItem* item) { Q_EMIT chosen(item->data(kFile).toString()); });
    tabs_->addTab(list, title);
    return list;
}

void StartPage::add(QListWidget* list, const QStringList& files) {
    QPixmap blank(kTileSize);
    blank.fill(palette().color(QPalette::Mid));
    for (const QString& file : files) {
        auto* item = new QListWidgetItem(QIcon(blank), QFileInfo(file).completeBaseName(), list);
        item->setData(kFile, file);
        item->setSizeHint(kItem - QSize(4, 4));
        item->setToolTip(QString("<p>%1</p><p><i>%2</i></p>")
                             .arg(head_of(file).toHtmlEscaped(), file.toHtmlEscaped()));
    }
    if (list->count() > 0) list->setCurrentRow(0);
}

template <class F>
void StartPage::each(const QString& file, const F& f) {
    for (QListWidget* list : {begin_, experiments_, scenes_, recent_}) {
        for (int i = 0; i < list->count(); ++i) {
            if (list->item(i)->data(kFile).toString() == file) f(*list->item(i));
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
    for (QListWidget* list : {begin_, experiments_, scenes_, recent_}) list->clear();
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
    shelf_.read(all);
    tabs_->currentWidget()->setFocus();
}

}  // namespace dihaptic::gui
