// What a person senses of the hands, the objects and the display. The display is seen with a delay,
// and what is seen is compared with what was felt at that time.
#pragma once

#include "person/eyes.h"
#include "person/felt_hand.h"
#include "person/held_cursor.h"
#include "person/past.h"
#include "person/seen_targets.h"
#include "person/strain.h"
#include "person/touch.h"

namespace dihaptic::person {

struct Senses {
    FeltHand felt;
    Eyes eyes;
    Touch touch;
    Past<Strain> strains;  ///< read with the delay of sight, to be compared with it
    SeenTargets targets;
    HeldCursor cursor;
    double delay;  ///< of sight [s]
    /// Last seen distance from the felt hand to the displayed one [m].
    Vec3 off_felt = Vec3::Zero();

    void restart() {
        eyes.restart();
        touch.restart();
        felt.restart();
        strains.clear();
        targets.restart();
        off_felt.setZero();
    }
    /// Felt position of the hand at the time that the person currently sees.
    const Vec3& felt_hand() const noexcept { return strains.before(delay).hand; }
    /// Position of the hand as seen or, while the display holds the cursor, as felt.
    const Vec3& hand(const Sight& sight) const noexcept {
        return cursor.is_held() ? felt_hand() : sight.hand;
    }
    /// Felt position of the hand at the time that the display shows, which is earlier if the cursor
    /// is held.
    const Vec3& felt_where_shown() const noexcept {
        return cursor.is_held() ? cursor.shown().felt : felt_hand();
    }
    /// How far the displayed hand has moved away from the felt one since the last call [m].
    Vec3 take_jump(const Sight& sight) noexcept {
        const Vec3 before = off_felt;
        off_felt = sight.hand - felt_hand();
        return off_felt - before;
    }
};

}  // namespace dihaptic::person
