// How the mouse and the keys over a scene are used for the simulated hand: which hand they move, if
// any, and which keys are held down.
#pragma once

#include <QKeyEvent>

#include "mouse_hand.h"

namespace dihaptic::gui {

class HandInput {
  public:
    /// Sets the hand; null if there is none. `squeezes`: whether the wheel squeezes the hand
    /// instead of moving it in depth.
    void set(MouseHand* hand, bool squeezes);
    explicit operator bool() const { return hand_ != nullptr; }
    MouseHand* operator->() const { return hand_; }
    bool squeezes() const { return squeezes_; }
    /// Whether the hand stays in place while the pointer moves.
    bool stays() const { return stays_; }
    void set_staying(bool stays) { stays_ = stays; }

    /// The squeeze that the keys currently held down command.
    MouseHand::Squeeze keys() const { return keys_; }
    void set_key(const QKeyEvent& event, bool down);
    void release_keys() { keys_ = MouseHand::Squeeze::none; }

  private:
    MouseHand* hand_ = nullptr;
    bool squeezes_ = false;
    bool stays_ = false;
    MouseHand::Squeeze keys_ = MouseHand::Squeeze::none;
};

}  // namespace dihaptic::gui
