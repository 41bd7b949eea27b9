// Reads the files for the start page, shipped ones or the user's, in a separate thread: their
// titles and lengths, and small pictures drawn by `dihaptic picture`.
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

    /// Reads these files one after the other, and draws those that have no picture yet.
    void read(const QStringList& files);
    /// Ends reading and drawing, which would keep the computer busy at a session's start.
    void stop();

    /// Path of the picture of a file in its present state, whether or not it exists.
    static QString picture_of(const QString& file);

  Q_SIGNALS:
    /// `length`: "45 trials", "8 s"; empty if the user decides when it ends. A file with an error
    /// has no length.
    void told(const QString& file, const QString& title, const QString& length);
    void drawn(const QString& file, const QString& picture);

  private:
    void draw_next();

    std::jthread thread_;
    QStringList to_draw_;
    QProcess* drawing_ = nullptr;
};

}  // namespace dihaptic::gui
