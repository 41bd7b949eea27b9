// The icons of the player's buttons, drawn in the colour of the theme's texts.
#pragma once

#include <QIcon>
#include <QPalette>

namespace dihaptic::gui {

enum class PlayerIcon { previous_moment, previous_tick, play, stop, next_tick, next_moment };

QIcon player_icon(PlayerIcon icon, const QPalette& palette);

}  // namespace dihaptic::gui
