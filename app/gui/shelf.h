// Reads the files for the start page, shipped files or the user's own, in a separate thread: their
// titles and durations, and small pictures drawn with `dihaptic picture`.
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

    /// Reads these files one after the other, and draws a picture of each file that has none yet.
    void read(const QStringList& files);
    /// Stops reading and drawing, which would keep the computer busy when a session starts.
    void stop();

    /// Path at which the picture of a file in its current state is stored, whether or not it exists
    /// yet.
    static QString picture_of(const QString& file);

  Q_SIGNALS:
    /// `title`: title of the file, or what to say instead if the file has an error. `length`:
    /// duration of the file's session, e.g. "45 trials" or "8 s"; empty if the user decides when it
    /// ends, or if the file has an error.
    void told(const QString& file, const QString& title, const QString& length);
    void drawn(const QString& file, const QString& picture);
    /// No pictures can be drawn. `why`: the reason, with its remedy.
    void cannot_draw(const QString& why);

  private:
    void draw_next();

    std::jthread thread_;
    QStringList to_draw_;
    QProcess* drawing_ = nullptr;
};

}  // namespace dihaptic::gui
