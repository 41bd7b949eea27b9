#include "watched_file.h"

#include <QFileInfo>

namespace dihaptic::gui {

WatchedFile::WatchedFile() {
    settled_.setSingleShot(true);
    settled_.setInterval(300);
    connect(&watcher_, &QFileSystemWatcher::fileChanged, this, [this] { settled_.start(); });
    // a missing file may have returned
    connect(&watcher_, &QFileSystemWatcher::directoryChanged, this, [this] {
        if (!watcher_.files().contains(path_) && QFileInfo::exists(path_)) settled_.start();
    });
    connect(&settled_, &QTimer::timeout, this, &WatchedFile::changed);
}

void WatchedFile::open(const QString& file) {
    path_ = file;
    if (const QStringList watched = watcher_.files() + watcher_.directories(); !watched.isEmpty())
        watcher_.removePaths(watched);
    watcher_.addPath(file);
    watcher_.addPath(QFileInfo(file).absolutePath());
}

void WatchedFile::watch() {
    // when an editor replaces the file, it is no longer being watched
    if (!watcher_.files().contains(path_)) watcher_.addPath(path_);
}

}  // namespace dihaptic::gui
