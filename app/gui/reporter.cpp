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
    if (thread_.joinable()) return;
    thread_ = std::thread([this, folder] {
        QString page;
        QString why;
        try {
            const std::string command = "dihaptic report " + folder.toStdString();
            const auto result = analysis::write_tables(folder.toStdString(), {});
            app::draw_page(result, command, app::PythonSays::in_error);
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
