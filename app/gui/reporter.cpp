#include "reporter.h"

#include <QtGlobal>
#include <exception>

#include "analysis/report/report.h"

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
            page = QString::fromStdString(
                analysis::write_report(folder.toStdString(), command, [](double) {}).page);
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
