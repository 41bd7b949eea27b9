// Events of a session as sentences, for people who look at the session.
#pragma once

#include <QString>

#include "rows/episode_row.h"
#include "rows/event_row.h"

namespace dihaptic::gui {

/// An event as a sentence, e.g. "thumb touches block". `fingers`: names of the scene's fingers,
/// which tell where the name of a finger ends.
QString sentence_of(const rows::EventRow& event, const std::vector<std::string>& fingers);

/// An episode of the object's movement as a sentence, with what was measured of it.
QString sentence_of(const rows::EpisodeRow& episode);

}  // namespace dihaptic::gui
