// The Qt application object. It sees the Escape key before any widget does, because a dialog, a
// menu or a field with the keyboard focus would consume the key. It also loads the translation for
// the system's language, if there is one.
#pragma once

#include <QApplication>
#include <QTranslator>

namespace dihaptic::gui {

class Application : public QApplication {
    Q_OBJECT

  public:
    /// Keeps numbers in the C locale, although Qt activates the system's: otherwise libraries would
    /// read 0.5 as 0.
    Application(int& argc, char** argv);
    bool notify(QObject* receiver, QEvent* event) override;
    /// If the folder contains dihaptic_LANGUAGE.qm for the system's language, switches the window's
    /// texts and Qt's own texts to this language.
    void translate(const QString& folder);

  Q_SIGNALS:
    /// Emitted before the key press has any other effect, possibly more than once per press.
    void escape_pressed();

  private:
    QTranslator texts_;
    QTranslator texts_of_qt_;
};

}  // namespace dihaptic::gui
