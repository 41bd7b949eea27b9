#include "save_dialog.h"

#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QSettings>
#include <QStandardPaths>
#include <filesystem>

#include "base/diagnostics.h"
#include "base/installed.h"
#include "common/output_file.h"

namespace dihaptic::gui {
namespace {

constexpr const char* kKey = "saved_in";

bool is_writable_folder(const QString& path) {
    const QFileInfo info(path);
    return info.isDir() && info.isWritable();
}

}  // namespace

QString usual_folder() {
    for (const QString& folder :
         {QSettings().value(kKey).toString(),
          QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation)}) {
        if (!folder.isEmpty() && is_writable_folder(folder)) return folder;
    }
    return QDir::homePath();
}

void remember_folder_of(const QString& file) {
    QSettings().setValue(kKey, QFileInfo(file).absolutePath());
}

bool is_own_folder(const QString& folder) {
    const QString path = QFileInfo(folder).canonicalFilePath();
    const QString shipped = QFileInfo(QString::fromStdString(shipped_folder())).canonicalFilePath();
    const bool is_shipped = !shipped.isEmpty() && (path + "/").startsWith(shipped + "/");
    return !is_shipped && is_writable_folder(folder);
}

QString ending_of(const QString& file) {
    return QString::fromStdString(std::filesystem::path(file.toStdString()).extension().string());
}

QString why_not_to_write(const QString& file, const QStringList& endings) {
    const QString own = ending_of(file);
    const QString ending = endings.contains(own) ? own : endings.front();
    try {
        app::check_output_file(file.toStdString(), "", "", ending.toStdString());
    } catch (const Error& e) {
        return QString::fromStdString(e.problems().front().text());
    }
    return "";
}

QString ask_where_to_save(const Saving& saving, QWidget* parent) {
    const QString usual = QDir(usual_folder()).filePath(saving.usual);
    QString file = QFileDialog::getSaveFileName(parent, saving.title, usual, saving.kinds);
    if (file.isEmpty()) return "";
    // the dialog has asked about replacing a file only for the name that was typed
    if (ending_of(file).isEmpty() && !QFileInfo::exists(file + saving.endings.front()))
        file += saving.endings.front();
    const QString why = why_not_to_write(file, saving.endings);
    if (why.isEmpty()) return file;
    auto* box =
        new QMessageBox(QMessageBox::Warning, saving.title, why, QMessageBox::Close, parent);
    box->setAttribute(Qt::WA_DeleteOnClose);
    box->open();
    return "";
}

}  // namespace dihaptic::gui
