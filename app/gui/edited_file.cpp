#include "edited_file.h"

#include <sys/stat.h>

#include <QFile>
#include <QFileInfo>

#include "base/diagnostics.h"
#include "base/disk.h"
#include "base/output.h"
#include "base/regular_file.h"
#include "base/text_file.h"

namespace dihaptic::gui {
namespace {

/// The path that a name refers to, with links resolved; for a missing file, the path that it would
/// have.
QString path_of(const QString& name) {
    const QFileInfo info(name);
    if (info.exists() || info.isSymLink()) return info.canonicalFilePath();
    return QFileInfo(info.absolutePath()).canonicalFilePath() + "/" + info.fileName();
}

}  // namespace

std::optional<QByteArray> bytes_of(const QString& file) {
    try {
        return QByteArray::fromStdString(read_bytes(file.toStdString(), kMostYaml));
    } catch (const Error&) {
        return {};  // the reason is reported when the file is opened
    }
}

EditedFile::EditedFile(const QString& name)
    : name_(name), path_(path_of(name)), content_(bytes_of(name)) {}

bool EditedFile::is_link() const {
    return QFileInfo(name_).isSymLink();
}

bool EditedFile::is_there() const {
    return QFileInfo::exists(name_);
}

bool EditedFile::leads_elsewhere() const {
    return path_of(name_) != path_;
}

bool EditedFile::has_changed() const {
    return bytes_of(path_) != content_;
}

void EditedFile::write(const QByteArray& content) {
    replace_file(path_, content);
    content_ = content;
}

void replace_file(const QString& file, const QByteArray& content) {
    const std::string name = file.toStdString();
    Output out(name);
    const QByteArray part = QFile::encodeName(QString::fromStdString(out.path()));
    QFile made(QString::fromStdString(out.path()));
    if (!made.open(QIODevice::WriteOnly | QIODevice::NewOnly) ||
        made.write(content) != content.size() || !made.flush())
        throw Error({name, 0}, "", "cannot be written: " + made.errorString().toStdString(),
                    "Check the folder's permissions and the disk's space.");
    struct stat before {};
    if (::lstat(name.c_str(), &before) == 0) ::chmod(part.constData(), before.st_mode & 07777);
    sync_to_disk(made.handle(), name);
    made.close();
    out.keep();
}

}  // namespace dihaptic::gui
