// Asks for a note about a session.
#pragma once

#include <QString>
#include <optional>

class QWidget;

namespace dihaptic::gui {

/// `before`: the present note. Returns nullopt if it stays unchanged.
std::optional<QString> ask_for_note(const QString& session, const QString& before, QWidget* parent);

}  // namespace dihaptic::gui
