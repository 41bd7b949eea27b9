// The quantities that the expressions of a task can use, and their values in each tick.
//
// Quantities in the Frame have the names given in visit(), such as grip_force and time; those of a
// finger or body are preceded by its name, such as thumb.handle_position.z and block.velocity.y. A
// name with components is a vector; .x, .y, .z (and .w for a rotation) select them. The other
// quantities are
//
//     block, block.x, block.speed         a body's origin
//     index, index.x, index.speed         a finger's handle
//     left, left.x, left.speed            the middle of a hand's handles
//     index.shown, left.shown             the displayed position
//     left.grip_force                     pinch force of the hand's own fingers
//     block.start                         a body's position at the beginning of the trial
//     hinge.angle, rail.displacement      a joint's coordinate; joints have no position
//     goal, goal.x, goal.radius           a region
//     time_in_state, time_in_trial, trial_num, attempt
//
// and the names that a task defines: draws, variables, factors. Handles are read in the current
// tick, everything else is taken from the last Frame. All values are in SI units. Unmeasured values
// are NaN.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/unit.h"
#include "frame/frame.h"
#include "frame/handle.h"
#include "scene/finger_set.h"

namespace dihaptic::task {

/// The source of a quantity's value. Values of the kinds up to `region` change only between trials,
/// as specified by the trial list; a level lies in a range that is known before the session.
enum class Kind { draw, factor, region, level, variable, figure, tick };

/// Location of the values that a name refers to.
struct Symbol {
    enum class Type { number, text, vector };
    int slot = -1;  ///< for a vector, the slot of x; the slots of y and z follow
    Type type = Type::number;
    Dimension dimension{};
    Kind kind = Kind::tick;
};

class Quantities {
  public:
    /// A thing that has a position: a body, or one or more fingers.
    struct Thing {
        int body = -1;
        scene::FingerSet fingers{};

        bool operator==(const Thing&) const = default;
    };
    struct Names {
        std::vector<std::string> fingers;
        std::vector<std::string> bodies;
        std::vector<std::string> joints;
        std::vector<std::string> regions;
        struct Hand {
            std::string name;
            scene::FingerSet fingers;
        };
        std::vector<Hand> hands;
    };
    Quantities() : Quantities(Names{}) {}
    explicit Quantities(Names names);

    /// Returns the quantity with this name, or nullopt if there is none.
    std::optional<Symbol> find(std::string_view name);
    /// Defines a number, replacing any earlier number with the same name. Its value is 0 until it
    /// is set.
    Symbol define(std::string name, Dimension dimension, Kind kind);
    /// Defines a text and its possible values. The value of the quantity is the index of a text,
    /// see text().
    Symbol define_text(std::string name, std::vector<std::string> levels, Kind kind);
    /// Defines a number without a name, which expressions refer to by its slot.
    Symbol define_unnamed(Dimension dimension);
    /// Whether expressions may look back over earlier trials (LookBack). Only expressions that are
    /// evaluated at the end of a trial may do so.
    bool looks_back() const { return looks_back_; }
    void let_look_back(bool allowed) { looks_back_ = allowed; }
    /// Index that represents a text in comparisons.
    int text(std::string_view text);
    const std::string& text(int index) const { return texts_[static_cast<size_t>(index)]; }
    /// The possible texts of the quantity; null if it was not defined with define_text().
    const std::vector<std::string>* levels(int slot) const;
    /// Whether the text is a possible value of some quantity.
    bool has_level(std::string_view text) const;
    /// Whether the task uses this name for a thing, a region or a defined quantity.
    bool knows(std::string_view name) const {
        return symbols_.find(name) != symbols_.end() || thing(name) || region(name);
    }
    /// Known names: names() lists all of them, things() those of bodies, fingers and hands,
    /// regions() those of regions, and fingers() those of fingers.
    std::vector<std::string> names() const;
    std::vector<std::string> things() const;
    const std::vector<std::string>& regions() const { return names_.regions; }
    const std::vector<std::string>& fingers() const { return names_.fingers; }

    /// Returns a body, finger or hand. "" means all fingers, as does "hand" unless a thing has this
    /// name.
    std::optional<Thing> thing(std::string_view name) const;
    /// Slot of a region's centre: x, y and z are followed by the radius. Returns nullopt if there
    /// is no such region.
    std::optional<int> region(std::string_view name) const;
    int region(size_t index) const { return regions_ + 4 * static_cast<int>(index); }
    /// Slot of a body's position at the beginning of the trial; x, y and z are in consecutive
    /// slots.
    int start(size_t body) const { return starts_ + 3 * static_cast<int>(body); }
    /// Slot of the number of fingers, out of the given ones, that press the body.
    int pressing(int body, const scene::FingerSet& fingers);
    /// Slot of the normal force between two things, summed over their fingers [N].
    int contact_force(const Thing& a, const Thing& b);

    /// Slot of the rate at which the number in a slot changes: the difference in the number over
    /// the last kRateTicks ticks, divided by their duration [1/s]. The rate is NaN until there have
    /// been that many consecutive ticks. Returns nullopt if the number is not measured in each
    /// tick.
    std::optional<int> rate(int slot);
    static constexpr size_t kRateTicks = 10;

    /// Sets the times since the state and the trial began [s], rounded to nanoseconds: the
    /// differences of sums of ticks have rounding errors, and `time_in_state < 0.3 s` must select
    /// the same ticks in each trial.
    void set_times(double in_state, double in_trial) noexcept {
        set(kTimeInState, std::round(in_state * 1e9) / 1e9);
        set(kTimeInTrial, std::round(in_trial * 1e9) / 1e9);
    }
    static constexpr int kTimeInState = 0;
    static constexpr int kTimeInTrial = 1;
    static constexpr int kTrial = 2;
    static constexpr int kAttempt = 3;

    void set(int slot, double value) noexcept { values_[static_cast<size_t>(slot)] = value; }
    void set(int slot, const Vec3& value) noexcept {
        for (int i = 0; i < 3; ++i) set(slot + i, value[i]);
    }
    /// Updates the values that change in each tick.
    void update(const frame::Frame& last, std::span<const frame::Handle> handles) noexcept;
    std::span<const double> values() const { return values_; }
    /// Converts a copy of values(), made before update(), to the values of the Frame `last` itself,
    /// in which the handles are from the same tick as everything else. `handles` are those of that
    /// Frame.
    void read_frame(const frame::Frame& last, std::span<const frame::Handle> handles,
                    std::span<double> values) const noexcept;

  private:
    /// How to read a value that changes in each tick.
    struct Source {
        enum class From {
            frame,
            finger,
            handle,
            turn,
            body,
            joint,
            middle,
            pressing,
            contact,
            grip
        };
        enum class Format { f64, i32, i64, u32, norm };
        From from = From::frame;
        Format format = Format::f64;
        int slot = -1;
        int index = 0;   ///< index of the finger, body or joint
        int offset = 0;  ///< offset from the beginning of the item [bytes]
        double scale = 1;
        Thing a{};  ///< the thing, if `from` is middle, pressing, contact or grip
        Thing b{};
        bool shown = false;  ///< whether the displayed position is read, if `from` is middle

        bool reads_handles() const { return from == From::handle || from == From::middle; }
    };
    struct Rate {
        int of = -1;  ///< slot of the number that changes
        int slot = -1;
        bool of_handle = false;  ///< the number is from a handle: until update(), the rate is that
                                 ///< of the last Frame
        std::array<double, kRateTicks> past{};  ///< the last kRateTicks values, in a ring buffer
    };
    struct Member;
    struct Lister;
    template <class Item>
    static std::vector<Member> members();
    static const std::vector<Member>& members_of(Source::From from);

    Symbol add(const std::string& name, Symbol symbol, int slots);
    std::optional<Symbol> find_member(const std::string& name, std::string_view member,
                                      Source source);
    std::optional<Symbol> find_of_finger(const std::string& name, std::string_view member, int i);
    std::optional<Symbol> find_of_body(const std::string& name, std::string_view member, int i);
    std::optional<Symbol> find_of_joint(const std::string& name);
    std::optional<Symbol> find_of_hand(const std::string& name, std::string_view member,
                                       const scene::FingerSet& fingers);
    std::optional<Symbol> find_of_region(std::string_view member, size_t i) const;
    int slot_of(Source source);
    static double read(const Source& source, const frame::Frame& last,
                       std::span<const frame::Handle> handles) noexcept;
    void update_rates(const frame::Frame& last) noexcept;
    static double number_at(const char* at, Source::Format format) noexcept;
    static double middle(const Source& source, const frame::Frame& last,
                         std::span<const frame::Handle> handles) noexcept;

    Names names_;
    int regions_ = 0;
    int starts_ = 0;
    std::map<std::string, Symbol, std::less<>> symbols_;
    std::map<int, std::vector<std::string>> levels_;  // possible texts, by slot
    std::vector<std::string> texts_;
    std::vector<Source> sources_;
    std::vector<double> values_;
    std::vector<Rate> rates_;
    // times at which the past values of rates were read [s]
    std::array<double, kRateTicks> times_{};
    size_t ticks_ = 0;       // number of consecutive ticks so far
    int64_t sequence_ = -1;  // number of the last tick
    bool looks_back_ = false;
};

}  // namespace dihaptic::task
