// Detects windows that another program destroys in the X server (xdotool windowclose, a window
// manager's kill). Qt continues as if they existed, although nobody can see, answer or close them.
#pragma once

#include <QAbstractNativeEventFilter>
#include <QObject>
#include <QWidget>

namespace dihaptic::gui {

class LostWindows : public QObject, public QAbstractNativeEventFilter {
    Q_OBJECT

  public:
    /// From now on the program's windows are watched, as long as this lives.
    LostWindows();
    bool nativeEventFilter(const QByteArray& kind, void* message, qintptr* result) override;

  Q_SIGNALS:
    /// Emitted for a destroyed window, after the earlier events have been handled.
    void lost(QWidget* window);
};

}  // namespace dihaptic::gui
