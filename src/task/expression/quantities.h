// The quantities that the expressions of a task can name, and their values in a tick.
//
// What the Frame records has the name that visit() gives it: grip_force, time; with the name of a
// finger or body before it, thumb.handle_position.z, block.velocity.y. A name that has components
// is a vector; .x, .y, .z (and .w of a rotation) name them. Beside these there are
//
//     block, block.x, block.speed         of a body's origin
//     index, index.x, index.speed         of a finger's handle
//     left, left.x, left.speed            of the middle of a hand's handles
//     index.shown, left.shown             where that is displayed
//     block.start                         where a body begins the trial
//     hinge.angle, rail.displacement      of a joint, which has no place of its own
//     goal, goal.x, goal.radius           of a region
//     time_in_state, time_in_trial, trial_num, attempt
//
// and what is defined by name: draws, variables, factors. Handles are those of this tick,
// everything else is from the last Frame; all in SI units. What is not measured is NaN.
#pragma once

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

/// What a quantity's value follows from. Up to `region` it changes with the trial alone, as the
/// list of trials has it; a level lies in a range that is known before the session.
enum class Kind { draw, factor, region, level, variable, figure, tick };

/// Where the values of a name are.
struct Symbol {
    enum class Type { number, text, vector };
    int slot = -1;  ///< of a vector: x; y and z follow
    Type type = Type::number;
    Dimension dimension{};
    Kind kind = Kind::tick;
};

class Quantities {
  public:
    /// What has a place: a body, or one or more fingers.
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

    /// Nullopt if nothing has that name.
    std::optional<Symbol> find(std::string_view name);
    /// A number of one's own; replaces what has had the name. Its value is 0 until it is set.
    Symbol define(std::string name, Dimension dimension, Kind kind);
    /// A text of one's own, which is one of these; its value is a text's index, see text().
    Symbol define_text(std::string name, std::vector<std::string> levels, Kind kind);
    /// Index by which a text is compared.
    int text(std::string_view text);
    const std::string& text(int index) const { return texts_[static_cast<size_t>(index)]; }
    /// The texts that the quantity may be; null if it is none that define_text() made.
    const std::vector<std::string>* levels(int slot) const;
    /// Whether one of these quantities may be the text.
    bool has_level(std::string_view text) const;
    /// Whether it is a name of this task: of a thing, of a region, or of one's own.
    bool knows(std::string_view name) const {
        return symbols_.find(name) != symbols_.end() || thing(name) || region(name);
    }
    /// All names; those of bodies, fingers and hands; of regions; of fingers.
    std::vector<std::string> names() const;
    std::vector<std::string> things() const;
    const std::vector<std::string>& regions() const { return names_.regions; }
    const std::vector<std::string>& fingers() const { return names_.fingers; }

    /// A body, finger or hand; "" is all fingers, and so is "hand" unless something is called so.
    std::optional<Thing> thing(std::string_view name) const;
    /// Slot of a region's centre: x, y, z, and then its radius; nullopt if there is no such region.
    std::optional<int> region(std::string_view name) const;
    int region(size_t index) const { return regions_ + 4 * static_cast<int>(index); }
    /// Slot of where a body begins the trial: x, y, z.
    int start(size_t body) const { return starts_ + 3 * static_cast<int>(body); }
    /// Slot of the number of these fingers that press the body.
    int pressing(int body, const scene::FingerSet& fingers);
    /// Slot of the normal force between two things, summed over their fingers [N].
    int contact_force(const Thing& a, const Thing& b);

    static constexpr int kTimeInState = 0;
    static constexpr int kTimeInTrial = 1;
    static constexpr int kTrial = 2;
    static constexpr int kAttempt = 3;

    void set(int slot, double value) noexcept { values_[static_cast<size_t>(slot)] = value; }
    void set(int slot, const Vec3& value) noexcept {
        for (int i = 0; i < 3; ++i) set(slot + i, value[i]);
    }
    /// Refreshes what follows the tick.
    void update(const frame::Frame& last, std::span<const frame::Handle> handles) noexcept;
    std::span<const double> values() const { return values_; }

  private:
    /// How a value of the tick is read.
    struct Source {
        enum class From { frame, finger, handle, turn, body, joint, middle, pressing, contact };
        enum class Format { f64, i32, i64, u32, norm };
        From from = From::frame;
        Format format = Format::f64;
        int slot = -1;
        int index = 0;   ///< of the finger, body or joint
        int offset = 0;  ///< in bytes, from the beginning of the item
        double scale = 1;
        Thing a{};  ///< middle, pressing, contact
        Thing b{};
        bool shown = false;  ///< middle
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
    static double number_at(const char* at, Source::Format format) noexcept;
    static double middle(const Source& source, const frame::Frame& last,
                         std::span<const frame::Handle> handles) noexcept;

    Names names_;
    int regions_ = 0;
    int starts_ = 0;
    std::map<std::string, Symbol, std::less<>> symbols_;
    std::map<int, std::vector<std::string>> levels_;  // by slot
    std::vector<std::string> texts_;
    std::vector<Source> sources_;
    std::vector<double> values_;
};

}  // namespace dihaptic::task
