// Makes new files and studies for the window, with `dihaptic new`.
#pragma once

#include <QObject>
#include <QWidget>

namespace dihaptic::gui {

class NewFiles : public QObject {
    Q_OBJECT

  public:
    enum class Kind { scene, experiment, study };

    /// `window`: the parent of the dialogs.
    explicit NewFiles(QWidget* window) : QObject(window), window_(window) {}

    /// Asks for a name, and makes what was asked for. `folder`: the folder that is offered.
    void make(Kind kind, const QString& folder);

  Q_SIGNALS:
    /// `file`: the new file or, of a study, its experiment.
    void made(const QString& file);
    void failed(const QString& why);

  private:
    QString ask(Kind kind, const QString& folder);
    void run(Kind kind, const QString& path);

    QWidget* window_;
};

}  // namespace dihaptic::gui
