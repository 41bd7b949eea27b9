// Asks where to save something, as every dialog of the window does that makes a file: begins in a
// folder of the user's own, and never replaces what belongs to a recorded session.
#pragma once

#include <QString>
#include <QStringList>
#include <QWidget>

namespace dihaptic::gui {

/// The folder in which such a dialog begins: the last one in which something was saved this way, or
/// else the user's documents.
QString usual_folder();
/// Whether the user's own files belong into this folder, into which they can be written: not among
/// those that come with the program.
bool is_own_folder(const QString& folder);
/// To be called after a file was saved.
void remember_folder_of(const QString& file);

struct Saving {
    QString title;
    QString usual;        ///< proposed name or, with a folder, path
    QString kinds;        ///< filter, such as "Pictures (*.png)"
    QStringList endings;  ///< such as ".png"; the first is added to a name without an ending
};
/// Returns the chosen path. Returns "" if the user cancels, or chooses a file that must not be
/// replaced, which a message explains.
QString ask_where_to_save(const Saving& saving, QWidget* parent);

/// Why a file must not be written to this path, with the remedy; "" if it may be. `endings`: those
/// of files that may be replaced.
QString why_not_to_write(const QString& file, const QStringList& endings);
/// The ending of a path, such as ".png"; "" if it has none.
QString ending_of(const QString& file);

}  // namespace dihaptic::gui
