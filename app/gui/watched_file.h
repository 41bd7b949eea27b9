// The open file, which other programs may change: watches it and its folder, because an editor may
// replace the file instead of writing into it.
#pragma once

#include <QFileSystemWatcher>
#include <QTimer>

namespace dihaptic::gui {

class WatchedFile : public QObject {
    Q_OBJECT

  public:
    WatchedFile();

    /// Watches `file` in place of any earlier one.
    void open(const QString& file);
    /// Watches the file again if another program has replaced it.
    void watch();
    /// The file as it was given to open(); empty before that.
    const QString& path() const { return path_; }

  Q_SIGNALS:
    void changed();

  private:
    QString path_;
    QFileSystemWatcher watcher_;
    QTimer settled_;  // delays changed(), because editors write files in steps
};

}  // namespace dihaptic::gui
