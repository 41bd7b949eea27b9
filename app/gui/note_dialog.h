// Asks the operator for a note about a session.
#pragma once

#include <QString>
#include <optional>

class QWidget;

namespace dihaptic::gui {

/// The file in a session's folder that holds its note, which reports show.
inline constexpr const char* kNoteFile = "note.txt";

/// `before`: the existing note. Returns nullopt if the note stays unchanged.
std::optional<QString> ask_for_note(const QString& session, const QString& before, QWidget* parent);

}  // namespace dihaptic::gui
