// Asks for a note about a session.
#pragma once

#include <QString>
#include <optional>

class QWidget;

namespace dihaptic::gui {

/// `before`: the note as it is. nullopt: it stays.
std::optional<QString> ask_for_note(const QString& session, const QString& before, QWidget* parent);

}  // namespace dihaptic::gui
