// The window's icons: outlines of one family, drawn in the colour of the text next to them. Their
// shapes are in the folder `icons`.
#pragma once

#include <QIcon>
#include <QPixmap>
#include <string_view>

namespace dihaptic::gui {

namespace shapes {
extern const std::string_view kBack, kFault, kForward, kHalted, kInformation, kLook, kNext, kNote,
    kPause, kPlay, kPrepare, kPrevious, kQuestion, kReady, kSkip, kStop, kTune, kWaiting, kWarning;
}  // namespace shapes

/// An icon for a button, which follows the theme, and is paler while the button is disabled.
QIcon icon(std::string_view shape);

/// A picture of an icon, for a label. `size`: [pixels of the label].
QPixmap icon_picture(std::string_view shape, const QColor& colour, int size, double scale);

}  // namespace dihaptic::gui
