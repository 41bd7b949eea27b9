// Asks the operator for a note about a session.
#pragma once

#include <QString>
#include <optional>

class QWidget;

namespace dihaptic::gui {

/// `before`: the existing note. Returns nullopt if the note stays unchanged.
std::optional<QString> ask_for_note(const QString& session, const QString& before, QWidget* parent);

}  // namespace dihaptic::gui
