#include "hand_input.h"

namespace dihaptic::gui {

void HandInput::set(MouseHand* hand, bool squeezes) {
    hand_ = hand;
    squeezes_ = squeezes;
    stays_ = false;
    release_keys();
}

void HandInput::set_key(const QKeyEvent& event, bool down) {
    if (hand_ == nullptr || event.isAutoRepeat()) return;
    MouseHand::Squeeze key = MouseHand::Squeeze::none;
    if (event.key() == Qt::Key_Space) key = MouseHand::Squeeze::close;
    if (event.key() == Qt::Key_V) key = MouseHand::Squeeze::open;
    if (key == MouseHand::Squeeze::none) return;
    if (down) {
        keys_ = key;
    } else if (keys_ == key) {
        release_keys();
    }
}

}  // namespace dihaptic::gui
