// A simulated person, who sees the display, feels the handles, and moves the simulated hand. The
// person knows the demands of each state of the task (the file's hand steps), but not the kinds of
// trials and perturbations, which can only be seen and felt. Fingers of a second hand perform the
// steps that name them, exactly as in the file.
#pragma once

#include <memory>
#include <optional>

#include "person/eyes.h"
#include "person/force_memory.h"
#include "person/gain_memory.h"
#include "person/grip.h"
#include "person/held_cursor.h"
#include "person/learned.h"
#include "person/rotation_memory.h"
#include "person/strain.h"
#include "person/traits.h"
#include "scene/scene.h"
#include "task/run/seeing_driver.h"
#include "task/run/task_hand.h"
#include "task/run/trial_numbers.h"

namespace dihaptic::person {

/// The situation in which a simulated person sits down.
struct Situation {
    std::shared_ptr<const task::TaskPlan> task;
    const scene::Scene& scene;
    const hand::HandSpec& hand;
    double tick;  ///< [s]
    uint64_t seed;
    size_t participant = 0;  ///< in a task for two: index of the participant whose hand this is
};

class Person final : public task::SeeingDriver {
  public:
    /// Throws Error when a task cannot move the situation's hand.
    Person(const Traits& traits, const Situation& situation);

    double duration() const override { return hand::kLongestScript; }
    const std::vector<Phase>& phases() const override { return phases_; }
    void restart() override;

    /// What the person has learned and retained overnight.
    Learned learned() const;
    /// Makes the person recall `before` from the beginning of the session on.
    void recall(Learned before);

    const Grip& grip() const { return grip_; }
    /// The knowledge learned in a state of the task, given by its index.
    const RotationMemory& rotations(size_t state) const { return rotations_[state]; }
    const ForceMemory& forces(size_t state) const { return forces_[state]; }

  private:
    hand::FingerTarget do_target(int finger, double t) const noexcept override;
    void do_see(const frame::Frame& frame) noexcept override;
    char do_take_key() noexcept override;

    void recall_known() noexcept;
    void measure(const frame::Frame& frame) noexcept;
    void follow_cues(const Sight& sight) noexcept;
    void await_trial() noexcept;
    void see_targets(const Sight& sight) noexcept;
    void begin_attempt() noexcept;
    void go_on(const Sight& sight) noexcept;
    void go_on_moving(const Sight& sight) noexcept;
    void try_again(const Sight& sight) noexcept;
    void begin_step(const Sight& sight) noexcept;
    void finish_step(const Sight& sight) noexcept;
    void move(const Aim& way, double duration, const Sight& sight) noexcept;
    void rest() noexcept;
    Vec3 plan_reach(const Sight& sight, const Vec3& displacement) noexcept;
    bool pushed(const frame::Frame& frame) const noexcept;
    Strain strain(const frame::Frame& frame) const noexcept;
    void feel_strain() noexcept;
    void watch_reach(const Sight& sight) noexcept;
    void end_reach() noexcept;
    bool correct(const Sight& sight) noexcept;
    const Vec3& felt_hand() const noexcept;
    const Vec3& hand(const Sight& sight) const noexcept;
    const Vec3& felt_where_shown() const noexcept;
    bool shows_earlier_reach() const noexcept;
    bool from_above(const Vec3& displacement) const noexcept;
    Vec3 made_for(const Vec3& displacement) const noexcept;
    void judge_extent(const Sight& sight) noexcept;
    Vec3 target(const Sight& sight, const task::TaskPlan::Step& step) const noexcept;
    void answer(const Sight& sight) noexcept;
    void rate(const task::TaskPlan::Questions& questions) noexcept;
    double stiffness() const noexcept;
    double noisy(double value, double share) noexcept;
    const std::vector<task::TaskPlan::Step>& steps() const noexcept;

    Traits traits_;
    std::shared_ptr<const task::TaskPlan> plan_;
    task::TrialNumbers numbers_;
    std::vector<std::vector<task::TaskPlan::Step>> steps_;  // by state
    size_t first_;                                          // index of the hand's first finger
    std::vector<hand::FingerPlace> places_;
    std::optional<task::TaskHand> other_;  // moves the fingers of other hands, without senses
    hand::Impedance impedance_;
    Aim start_;
    uint64_t seed_;
    std::vector<Phase> phases_;

    // senses
    Random random_;
    double now_ = 0;  // [s]
    Eyes eyes_;
    Touch touch_;
    double half_ = 0;             // half the aperture of the handles [m]
    double touched_ = 0;          // half_ when both fingers touched [m]
    Vec3 centre_ = Vec3::Zero();  // of the handles [m]
    double felt_ = 0;          // force on a finger, smoothed like the stiffness that follows it [N]
    Past<Strain> strains_;     // delayed like sight, for comparison with it
    std::vector<Vec3> known_;  // where each region was last seen [m]
    HeldCursor cursor_;
    uint32_t seen_ = 0;  // regions that have been seen, one bit each

    // memory
    Learned before_;  // in earlier sessions
    std::vector<std::string> bodies_;
    std::vector<RotationMemory> rotations_;  // by state: learning in one state stays in it
    std::vector<GainMemory> gains_;          // by state
    std::vector<ForceMemory> forces_;        // by state
    Grip grip_;

    // actions
    enum class Doing { nothing, waiting, moving, preloading, loading, releasing };
    Doing doing_ = Doing::nothing;
    Strokes aim_;
    int trial_ = 0;
    int attempt_ = 0;
    int phase_ = 0;
    int acting_ =
        0;  // the state whose steps are being performed; unchanged by later states without steps
    bool between_ = true;    // between trials
    double since_ = 0;       // start of the state, of the time between trials, or of idleness [s]
    double wait_until_ = 0;  // [s]
    size_t step_ = 0;
    Aim pending_;  // the current movement; in a lift it starts when the object comes off
    double pending_time_ = 0;  // duration of that movement [s]
    int corrections_ = 0;
    double missed_ = 0;  // before the last correction [m]
    double delay_ = 0;   // hesitation before this trial's next movement [s]
    struct Reach {
        bool going = false;
        bool mended = false;  // the reach was corrected in its course
        bool seen = false;    // its direction error was seen
        bool ended = false;   // its first stroke has ended, and its extent was judged
        bool pushed = false;  // a push was felt before its error was judged
        int number = 0;       // from 1
        size_t state = 0;
        Vec3 from = Vec3::Zero();       // displayed position of the hand at the start [m]
        Vec3 felt_from = Vec3::Zero();  // ... and its felt position [m]
        Vec3 way = Vec3::Zero();        // displacement to be shown [m]
        Vec3 error = Vec3::Zero();      // rotation vector from `way` to the hand's direction [rad]

        double begin = 0;             // start of its first stroke [s]
        double duration = 0;          // duration of that stroke; 0: not started [s]
        Vec3 along = Vec3::Zero();    // unit direction in which the hand means to move
        Vec3 strayed = Vec3::Zero();  // deviation of that stroke from this direction, by noise [m]
        Vec3 presses = Vec3::Zero();  // force against a push, per speed along it [N*s/m]
        Vec3 push = Vec3::Zero();     // sum of push times speed [N*m/s]
        double moved = 0;             // sum of squared speed; 0: nothing pushed [m^2/s^2]
    };
    Reach reach_;

    // answers
    Vec3 shown_from_ =
        Vec3::Zero();  // start of the last movement of sufficient length, as shown [m]
    Vec3 felt_from_ = Vec3::Zero();  // ... and as felt [m]
    double answer_at_ = -1;          // time of the answer [s]; negative: no question
    size_t rated_ = 0;               // number of the state's questions answered so far
    char key_ = 0;
    std::array<char, 12> typed_{};  // digits of a rating
    size_t typed_length_ = 0;
    size_t typed_at_ = 0;
};

}  // namespace dihaptic::person
