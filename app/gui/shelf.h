// Reads what there is to begin with, shipped or one's own, in a thread of its own: the titles and
// lengths of files, and small pictures of them, which `dihaptic picture` draws.
#pragma once

#include <QObject>
#include <QProcess>
#include <QStringList>
#include <thread>

namespace dihaptic::gui {

class Shelf : public QObject {
    Q_OBJECT

  public:
    using QObject::QObject;
    ~Shelf() override;

    /// Reads these files, one after the other, and draws those that have no picture yet.
    void read(const QStringList& files);
    /// Ends reading and drawing, which would keep the computer busy: a session begins.
    void stop();

    /// Where the picture of a file is, or is to be, as the file is now.
    static QString picture_of(const QString& file);

  Q_SIGNALS:
    /// `length`: "45 trials", "8 s"; empty if it ends when one likes. A file with an error has
    /// none.
    void told(const QString& file, const QString& title, const QString& length);
    void drawn(const QString& file, const QString& picture);

  private:
    void draw_next();

    std::jthread thread_;
    QStringList to_draw_;
    QProcess* drawing_ = nullptr;
};

}  // namespace dihaptic::gui
