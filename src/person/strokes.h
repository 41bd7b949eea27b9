// A movement as a sum of minimum-jerk strokes (Flash and Henis 1991). A correction is another
// stroke, added to the strokes that are under way.
//
//     x(t) = x0 + sum d_i share((t - t_i) / T_i)
//
// Here d_i is the displacement of stroke i, t_i its start time and T_i its duration; share() is
// defined in model/minimum_jerk.h.
#pragma once

#include <array>

#include "base/geometry.h"
#include "model/minimum_jerk.h"

namespace dihaptic::person {

/// The aim of a hand: its centre, its aperture, and the force with which it carries objects. The
/// type is also used for differences between aims and for their rates of change.
struct Aim {
    Vec3 centre = Vec3::Zero();  ///< [m]
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

    /// Adds a stroke that begins at `now` + `delay`. If there are already kMost strokes, the first
    /// is treated as completed.
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

    /// Shifts the aim immediately, without a stroke.
    void shift(const Aim& way) noexcept { base_ += way; }

    Aim at(double t) const noexcept {
        Aim out = base_;
        for (size_t i = 0; i < count_; ++i)
            out += strokes_[i].way * model::minimum_jerk(strokes_[i].share(t)).share;
        return out;
    }
    /// First derivative of the aim with respect to time.
    Aim rate(double t) const noexcept {
        Aim out;
        for (size_t i = 0; i < count_; ++i) {
            const Stroke& stroke = strokes_[i];
            out += stroke.way * (model::minimum_jerk(stroke.share(t)).rate / stroke.duration);
        }
        return out;
    }
    /// Acceleration of the centre [m/s^2].
    Vec3 acceleration(double t) const noexcept {
        Vec3 out = Vec3::Zero();
        for (size_t i = 0; i < count_; ++i) {
            const Stroke& stroke = strokes_[i];
            out += stroke.way.centre * (model::minimum_jerk_acceleration(stroke.share(t)) /
                                        (stroke.duration * stroke.duration));
        }
        return out;
    }
    /// The aim when all strokes have ended.
    Aim goal() const noexcept {
        Aim out = base_;
        for (size_t i = 0; i < count_; ++i) out += strokes_[i].way;
        return out;
    }
    /// Time at which the last stroke ends [s].
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
