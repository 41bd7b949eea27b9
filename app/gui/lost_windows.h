// Detects windows that another program destroys in the X server (xdotool windowclose, a window
// manager's kill). Qt continues as if these windows existed, although nobody can see, answer or
// close them.
#pragma once

#include <QAbstractNativeEventFilter>
#include <QObject>
#include <QWidget>

namespace dihaptic::gui {

class LostWindows : public QObject, public QAbstractNativeEventFilter {
    Q_OBJECT

  public:
    /// Starts watching the program's windows, for as long as this object lives.
    LostWindows();
    bool nativeEventFilter(const QByteArray& kind, void* message, qintptr* result) override;

  Q_SIGNALS:
    /// Emitted when a window was destroyed, after all earlier events have been handled.
    void lost(QWidget* window);
};

}  // namespace dihaptic::gui
