#include "display_loss.h"

#include <QString>

#include <X11/Xlib.h>  // included last, because it defines ordinary words as macros

namespace dihaptic::gui {
namespace {

void (*lost)() = nullptr;
QtMessageHandler usual_messages = nullptr;
XIOErrorHandler usual_end = nullptr;

/// Calls lost() for messages after which Qt ends the program at once; on Wayland, Qt does not even
/// call exit().
void on_message(QtMsgType type, const QMessageLogContext& context, const QString& text) {
    usual_messages(type, context, text);
    if (type == QtFatalMsg || text.startsWith("The Wayland connection ") ||
        text.startsWith("The X11 connection broke"))
        lost();
}

int on_io_error(Display* display) {
    lost();
    return usual_end(display);
}

}  // namespace

void at_display_loss(void (*act)()) {
    lost = act;
    usual_messages = qInstallMessageHandler(on_message);
    usual_end = XSetIOErrorHandler(on_io_error);
}

}  // namespace dihaptic::gui
