#include "help_page.h"

#include <QCoreApplication>
#include <QDesktopServices>
#include <QUrl>

#include "base/installed.h"

namespace dihaptic::gui {
namespace {

std::string page_of(const std::string& name) {
    if (name == "index")
        return in_or_above_program(
            {"docs/html/index.html", "share/doc/dihaptic/manual/index.html"});
    for (const std::string part : {"reference/", "how-to/"}) {
        const std::string page =
            in_or_above_program({"docs/html/" + part + name + ".html",
                                 "share/doc/dihaptic/manual/" + part + name + ".html"});
        if (!page.empty()) return page;
    }
    return "";
}

}  // namespace

QString show_help_page(const QString& name) {
    const std::string page = page_of(name.toStdString());
    if (page.empty()) {
        return QCoreApplication::translate("HelpPage",
                                           "The manual is not on this computer yet.\n\nInstall the "
                                           "package dihaptic-doc or, in a folder with Dihaptic's "
                                           "sources, make it with ./dev docs.");
    }
    const QString file = QString::fromStdString(page);
    if (QDesktopServices::openUrl(QUrl::fromLocalFile(file))) return "";
    return QCoreApplication::translate("HelpPage", "No program can show %1: open it yourself.")
        .arg(file);
}

}  // namespace dihaptic::gui
