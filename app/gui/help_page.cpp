#include "help_page.h"

#include <QCoreApplication>
#include <QDesktopServices>
#include <QUrl>

#include "base/installed.h"

namespace dihaptic::gui {
namespace {

std::string page_of(const std::string& name) {
    if (name == "index") {
        return in_or_above_program(
            {"docs/html/index.html", "share/doc/dihaptic/manual/index.html", "README.md"});
    }
    std::string page;
    for (const std::string part : {"reference/", "how-to/"}) {
        page = in_or_above_program({"docs/html/" + part + name + ".html",
                                    "share/doc/dihaptic/manual/" + part + name + ".html"});
        if (!page.empty()) return page;
    }
    return in_or_above_program({"docs/" + name + ".md"});
}

}  // namespace

QString show_help_page(const QString& name) {
    const std::string page = page_of(name.toStdString());
    if (page.empty()) {
        return QCoreApplication::translate("HelpPage",
                                           "The manual is missing: install the package "
                                           "dihaptic-doc, or make the manual with ./dev docs.");
    }
    const QString file = QString::fromStdString(page);
    if (QDesktopServices::openUrl(QUrl::fromLocalFile(file))) return "";
    return QCoreApplication::translate("HelpPage", "No program can show %1: open it yourself.")
        .arg(file);
}

}  // namespace dihaptic::gui
