#include "main_program.h"

#include <QCoreApplication>

#include "base/installed.h"

namespace dihaptic::gui {

QString main_program() {
    return QString::fromStdString(in_or_above_program({"dihaptic", "bin/dihaptic"}));
}

QString main_program_is_missing() {
    return QCoreApplication::translate(
               "MainProgram",
               "The program dihaptic is missing: it belongs in the folder of this window's "
               "program, "
               "%1, or in the folder bin above. Build all of Dihaptic, or install it again.")
        .arg(QCoreApplication::applicationDirPath());
}

}  // namespace dihaptic::gui
