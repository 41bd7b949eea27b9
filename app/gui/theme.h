// The window's look: the one home of its colours, spacings and sizes of type.
#pragma once

#include <QColor>
#include <QFont>
#include <string_view>

namespace dihaptic::gui {

/// Sets the theme of the whole program.
void set_dark(bool dark);

/// The sign under which the window shows a session. Each has a colour, an icon and a word of its
/// own, so that nobody confuses them, however they see colours.
enum class Sign {
    idle,     ///< nothing runs
    busy,     ///< a file is being read, or files are being written
    running,  ///< the session runs
    paused,   ///< the operator has paused it
    stopped,  ///< Escape has taken the force away
    fault,    ///< a fault has taken the force away, a file has errors, or no session could start
    warning   ///< the last session is not finished, or its recording has a fault
};
inline constexpr int kSigns = 7;

struct SignLook {
    QColor fill;            ///< background
    QColor ink;             ///< text and icon on it
    std::string_view icon;  ///< icons.h
};
/// The same in both themes, because a sign is learned.
SignLook look_of(Sign sign);

/// The colour of a mark on the window's background.
enum class Tone { good, bad };
QColor tone(Tone tone);
/// A colour of the data, lighter or darker as far as it must be to stand out from the theme's
/// background.
QColor legible(const QColor& colour);
/// The same for a text on `paper`, which needs more contrast.
QColor readable(const QColor& colour, const QColor& paper);

/// Spacings [pixels].
namespace space {
inline constexpr int kTight = 4;
inline constexpr int kUsual = 8;
inline constexpr int kWide = 16;
}  // namespace space

/// Sizes of type, relative to the system's font, which the user chose.
namespace type {
inline constexpr double kHeading = 1.25;
inline constexpr double kLarge = 1.6;
}  // namespace type
QFont sized(QFont font, double by, bool bold = false);

}  // namespace dihaptic::gui
