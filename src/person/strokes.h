// A movement as a sum of minimum-jerk strokes (Flash and Henis 1991): a correction is one more
// stroke, added to what goes on.
//
//     x(t) = x0 + sum d_i share((t - t_i) / T_i)
//
// with the displacements d_i, begun at t_i, lasting T_i (model/minimum_jerk.h).
#pragma once

#include <array>

#include "base/geometry.h"
#include "model/minimum_jerk.h"

namespace dihaptic::person {

/// What a hand aims at: its centre, its aperture, and the force that it carries objects with.
struct Aim {
    Vec3 centre = Vec3::Zero();  ///< [m], the same in strokes; its derivatives by time where said
    double aperture = 0;         ///< [m]
    double load = 0;             ///< upward [N]

    Aim& operator+=(const Aim& other) noexcept {
        centre += other.centre;
        aperture += other.aperture;
        load += other.load;
        return *this;
    }
    Aim operator*(double share) const noexcept {
        return {share * centre, share * aperture, share * load};
    }
};

class Strokes {
  public:
    void rest(const Aim& aim) noexcept {
        base_ = aim;
        count_ = 0;
        end_ = 0;
    }

    /// A stroke more, from `delay` after `now` on; of so many that nobody makes them, the first is
    /// taken as done.
    void add(const Aim& way, double now, double duration, double delay = 0) noexcept {
        size_t kept = 0;
        for (size_t i = 0; i < count_; ++i) {
            const Stroke stroke = strokes_[i];
            const bool full = count_ == kMost && i == 0;
            if (full || now >= stroke.start + stroke.duration) {
                base_ += stroke.way;
            } else {
                strokes_[kept++] = stroke;
            }
        }
        count_ = kept;
        strokes_[count_++] = {way, now + delay, duration};
        end_ = std::max(end_, now + delay + duration);
    }

    /// The aim is another by so much, at once.
    void shift(const Aim& way) noexcept { base_ += way; }

    Aim at(double t) const noexcept {
        Aim out = base_;
        for (size_t i = 0; i < count_; ++i)
            out += strokes_[i].way * model::minimum_jerk(strokes_[i].share(t)).share;
        return out;
    }
    /// First derivative by time.
    Aim rate(double t) const noexcept {
        Aim out;
        for (size_t i = 0; i < count_; ++i) {
            const Stroke& stroke = strokes_[i];
            out += stroke.way * (model::minimum_jerk(stroke.share(t)).rate / stroke.duration);
        }
        return out;
    }
    /// Of the centre [m/s^2].
    Vec3 acceleration(double t) const noexcept {
        Vec3 out = Vec3::Zero();
        for (size_t i = 0; i < count_; ++i) {
            const Stroke& stroke = strokes_[i];
            out += stroke.way.centre * (model::minimum_jerk_acceleration(stroke.share(t)) /
                                        (stroke.duration * stroke.duration));
        }
        return out;
    }
    /// Where all of them lead.
    Aim goal() const noexcept {
        Aim out = base_;
        for (size_t i = 0; i < count_; ++i) out += strokes_[i].way;
        return out;
    }
    /// When the last one ends [s].
    double end() const noexcept { return end_; }

  private:
    struct Stroke {
        Aim way;
        double start = 0;
        double duration = 1;

        double share(double t) const noexcept { return (t - start) / duration; }
    };
    static constexpr size_t kMost = 12;
    Aim base_;
    std::array<Stroke, kMost> strokes_;
    size_t count_ = 0;
    double end_ = 0;
};

}  // namespace dihaptic::person
