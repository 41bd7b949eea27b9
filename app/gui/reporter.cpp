#include "reporter.h"

#include <QtGlobal>
#include <exception>

#include "analysis/report/report.h"
#include "common/drawn_report.h"

namespace dihaptic::gui {

Reporter::~Reporter() {
    if (thread_.joinable()) thread_.join();
}

void Reporter::write(const QString& folder) {
    if (busy())
        return Q_EMIT told(
            tr("A report is still being drawn: try again when the browser shows it."));
    Q_EMIT told(tr("The report of %1 is being drawn; the browser shows it.").arg(folder));
    thread_ = std::thread([this, folder] {
        QString page;
        QString why;
        try {
            const std::string command = "dihaptic report " + folder.toStdString();
            app::PageDrawer drawer({folder.toStdString()}, app::PythonSays::in_error);
            const auto result = analysis::write_tables(folder.toStdString(), {});
            drawer.draw(result, command);
            page = QString::fromStdString(result.page());
        } catch (const std::exception& e) {
            why = QString::fromStdString(e.what());
        }
        QMetaObject::invokeMethod(
            this,
            [this, page, why] {
                thread_.join();
                if (why.isEmpty()) {
                    Q_EMIT written(page);
                } else {
                    Q_EMIT failed(why);
                }
            },
            Qt::QueuedConnection);
    });
}

}  // namespace dihaptic::gui
