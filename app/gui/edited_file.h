// The file that the editor has open, as it is on the disk: whoever else changes it, removes it or
// puts a link in its place is noticed before anything is written.
#pragma once

#include <QByteArray>
#include <QString>
#include <optional>

namespace dihaptic::gui {

/// A regular file's bytes; nullopt if it cannot be read, or is no text by its size.
std::optional<QByteArray> bytes_of(const QString& file);

class EditedFile {
  public:
    EditedFile() = default;
    /// Reads it.
    explicit EditedFile(const QString& name);

    const QString& name() const { return name_; }
    /// Path of what is edited: of what a link leads to, if the name is one's.
    const QString& path() const { return path_; }
    /// As it was read or written last.
    QByteArray content() const { return content_.value_or(QByteArray()); }
    bool was_readable() const { return content_.has_value(); }
    bool is_link() const;
    bool is_there() const;
    bool is_readable() const { return bytes_of(name_).has_value(); }
    /// Whether the name leads where it led when it was opened.
    bool leads_elsewhere() const;
    /// Whether it has become another since it was read or written: not the same bytes, or gone.
    bool has_changed() const;
    /// Replaces it, in place of whatever is there now. Throws Error when it cannot.
    void write(const QByteArray& content);

  private:
    QString name_;
    QString path_;
    std::optional<QByteArray> content_;
};

/// Replaces a file as a whole; a new one in its place has its permissions. Throws Error, also if
/// the name is a link's.
void replace_file(const QString& file, const QByteArray& content);

}  // namespace dihaptic::gui
