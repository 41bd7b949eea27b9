// The file that is open in the editor, as it was last seen on disk. If another program changes the
// file, removes it or replaces it with a link, this is noticed before anything is written.
#pragma once

#include <QByteArray>
#include <QString>
#include <optional>

namespace dihaptic::gui {

/// The bytes of a regular file; nullopt if the file cannot be read or is too large to be edited as
/// text.
std::optional<QByteArray> bytes_of(const QString& file);

class EditedFile {
  public:
    EditedFile() = default;
    /// Reads it.
    explicit EditedFile(const QString& name);

    const QString& name() const { return name_; }
    /// Path of the edited file; if the name is a link, the path of its target.
    const QString& path() const { return path_; }
    /// The file's contents when it was last read or written.
    QByteArray content() const { return content_.value_or(QByteArray()); }
    bool was_readable() const { return content_.has_value(); }
    bool is_link() const;
    bool is_there() const;
    bool is_readable() const { return bytes_of(name_).has_value(); }
    /// Whether the name no longer refers to the same file as when it was opened.
    bool leads_elsewhere() const;
    /// Whether the file on disk differs from the version last read or written, or is missing.
    bool has_changed() const;
    /// Writes the file at its original path, whatever its name refers to now. Throws Error when
    /// this fails.
    void write(const QByteArray& content);

  private:
    QString name_;
    QString path_;
    std::optional<QByteArray> content_;
};

/// Replaces the whole file; the new file keeps the permissions. Throws Error when this fails, also
/// if the name is a link.
void replace_file(const QString& file, const QByteArray& content);

}  // namespace dihaptic::gui
