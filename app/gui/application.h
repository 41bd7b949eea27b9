// The Qt application object. It sees Escape before any widget does, because a dialog, a menu or a
// field with the keyboard focus would consume the key. It also loads the translation for the
// system's language, if there is one.
#pragma once

#include <QApplication>
#include <QTranslator>

namespace dihaptic::gui {

class Application : public QApplication {
    Q_OBJECT

  public:
    /// Qt activates the system's language; for numbers this is reversed, because libraries would
    /// otherwise read 0.5 as 0.
    Application(int& argc, char** argv);
    bool notify(QObject* receiver, QEvent* event) override;
    /// From now on, the window's texts and Qt's own are in the system's language, if the folder
    /// contains dihaptic_LANGUAGE.qm.
    void translate(const QString& folder);

  Q_SIGNALS:
    /// Sent before the key has any other effect; may be sent more than once for a press.
    void escape_pressed();

  private:
    QTranslator texts_;
    QTranslator texts_of_qt_;
};

}  // namespace dihaptic::gui
