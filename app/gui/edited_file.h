// The file that is open in the editor, in its state on the disk. If another program changes it,
// removes it or replaces it by a link, this is noticed before anything is written.
#pragma once

#include <QByteArray>
#include <QString>
#include <optional>

namespace dihaptic::gui {

/// A regular file's bytes; nullopt if it cannot be read, or is too large for a text.
std::optional<QByteArray> bytes_of(const QString& file);

class EditedFile {
  public:
    EditedFile() = default;
    /// Reads it.
    explicit EditedFile(const QString& name);

    const QString& name() const { return name_; }
    /// Path of the edited file: the target, if the name is a link.
    const QString& path() const { return path_; }
    /// The file's content when it was last read or written.
    QByteArray content() const { return content_.value_or(QByteArray()); }
    bool was_readable() const { return content_.has_value(); }
    bool is_link() const;
    bool is_there() const;
    bool is_readable() const { return bytes_of(name_).has_value(); }
    /// Whether the name still leads to the same file as when it was opened.
    bool leads_elsewhere() const;
    /// Whether the file differs from the version read or written: changed bytes, or missing.
    bool has_changed() const;
    /// Replaces the file, whatever its name leads to now. Throws Error when this fails.
    void write(const QByteArray& content);

  private:
    QString name_;
    QString path_;
    std::optional<QByteArray> content_;
};

/// Replaces the whole file; the new one keeps its permissions. Throws Error, also if the name is a
/// link.
void replace_file(const QString& file, const QByteArray& content);

}  // namespace dihaptic::gui
