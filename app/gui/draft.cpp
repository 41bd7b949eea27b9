#include "draft.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <QCryptographicHash>
#include <QFile>
#include <QFileInfo>
#include <cerrno>
#include <cstring>

#include "base/diagnostics.h"
#include "base/output.h"
#include "base/regular_file.h"
#include "base/text_file.h"

namespace dihaptic::gui {
namespace {

constexpr const char* kBelow = "dihaptic/drafts";

QString state_folder() {
    const QString given = qEnvironmentVariable("XDG_STATE_HOME");
    // a relative path is ignored, as the XDG specification demands
    return given.startsWith('/') ? given : qEnvironmentVariable("HOME") + "/.local/state";
}

QByteArray lock_of(const QString& path) {
    return QFile::encodeName(path + ".lock");
}

}  // namespace

Draft::Draft(const QString& file)
    : file_(file),
      path_(state_folder() + "/" + kBelow + "/" +
            QString::fromLatin1(
                QCryptographicHash::hash(file.toUtf8(), QCryptographicHash::Sha256).toHex()) +
            ".draft") {}

Draft::~Draft() {
    if (lock_) ::unlink(lock_of(path_).constData());
}

/// The first line of a draft, which tells programs and human readers to which file the draft
/// belongs.
QString Draft::head() const {
    return QString("Dihaptic's draft of %1\n").arg(QString(file_).replace('\n', ' '));
}

bool Draft::take() {
    if (lock_) return true;
    make_folders(state_folder().toStdString(), kBelow);
    for (int tries = 0; tries < 100; ++tries) {
        if (try_lock()) return true;
        if (errno == EWOULDBLOCK) return false;
        if (errno != ENOENT) break;
    }
    throw Error({lock_of(path_).toStdString(), 0}, "",
                fmt::format("cannot be made: {}", std::strerror(errno)),
                "Check the folder's permissions.");
}

/// Tries to lock the draft. On failure, sets errno; ENOENT means that the previous window has just
/// removed the draft.
bool Draft::try_lock() {
    const QByteArray name = lock_of(path_);
    Descriptor lock(::open(name.constData(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600));
    struct stat locked {
    }, named{};
    if (!lock || ::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) return false;
    if (::fstat(lock.get(), &locked) == 0 && ::lstat(name.constData(), &named) == 0 &&
        locked.st_ino == named.st_ino) {
        lock_ = std::move(lock);
        return true;
    }
    errno = ENOENT;
    return false;
}

std::optional<Draft::Left> Draft::left() const {
    const QFileInfo info(path_);
    if (info.isSymLink() || !info.isFile()) return {};
    try {
        const QString all = QString::fromStdString(read_text_file(path_.toStdString()));
        if (!all.startsWith(head())) return {};
        return Left{all.mid(head().size()), info.lastModified()};
    } catch (const Error&) {
        return {};  // not a draft left by a window
    }
}

void Draft::write(const QString& text) const {
    // unfinished work should not be readable by other users
    Output out(path_.toStdString());
    const QString part = QString::fromStdString(out.path());
    QFile file(part);
    const QByteArray content = (head() + text).toUtf8();
    const bool written = file.open(QIODevice::WriteOnly | QIODevice::NewOnly) &&
                         file.setPermissions(QFile::ReadOwner | QFile::WriteOwner) &&
                         file.write(content) == content.size() && file.flush();
    if (!written)
        throw Error({path_.toStdString(), 0}, "",
                    "cannot be written: " + file.errorString().toStdString(),
                    "Check the folder's permissions and the disk's space.");
    file.close();
    out.keep();
}

void Draft::remove() const {
    QFile::remove(path_);
}

}  // namespace dihaptic::gui
