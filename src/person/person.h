// A simulated person who sees the display, feels the handles, and moves the simulated hand. The
// person knows what each state of the task demands (the hand steps in the file), but not the kinds
// of trials or the perturbations, which can only be seen and felt. The fingers of a second hand
// follow the steps that name them, exactly as written in the file. person_reach.cpp contains its
// reaches, person.cpp all else.
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

/// The situation in which a simulated person does a task.
struct Situation {
    std::shared_ptr<const task::TaskPlan> task;
    const scene::Scene& scene;
    const hand::HandSpec& hand;
    double tick;  ///< [s]
    uint64_t seed;
    size_t participant = 0;  ///< in a task for two, index of the participant who owns this hand
};

class Person final : public task::SeeingDriver {
  public:
    /// Throws Error when the hand in this situation cannot be moved by a task.
    Person(const Traits& traits, const Situation& situation);

    double duration() const override { return hand::kLongestScript; }
    const std::vector<Phase>& phases() const override { return phases_; }
    void restart() override;

    /// What the person has learned and will retain overnight.
    Learned learned() const;
    /// Makes the person recall `before` from the start of the session on.
    void recall(Learned before);

    const Grip& grip() const { return grip_; }
    /// What the person has learned about rotations in a state of the task, given by its index.
    const RotationMemory& rotations(size_t state) const { return rotations_[memory_[state]]; }
    const ForceMemory& forces(size_t state) const { return forces_[memory_[state]]; }

  private:
    static constexpr double kReach =
        0.03;  // shortest movement from which rotations are learned [m]
    static constexpr double kShortest = 0.2;  // shortest duration of a stroke [s]

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
    Vec3 plan_reach(const Sight& sight, const Vec3& goal) noexcept;
    Vec3 astray(const Vec3& way, const Vec3& displacement) const noexcept;
    bool pushed(const frame::Frame& frame) const noexcept;
    Strain strain(const frame::Frame& frame) const noexcept;
    void feel_strain() noexcept;
    void learn_lag() noexcept;
    void stray() noexcept;
    void give_way() noexcept;
    void follow_jumps(const Sight& sight) noexcept;
    void redirect(const Vec3& displacement) noexcept;
    double beyond_noise(double angle, double distance) const noexcept;
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
    size_t first_;                                          // index of the first finger of the hand
    std::vector<hand::FingerPlace> places_;
    std::optional<task::TaskHand> other_;  // moves the fingers of other hands, which feel nothing
    hand::Impedance impedance_;
    Aim start_;
    uint64_t seed_;
    std::vector<Phase> phases_;

    // senses
    Random random_;
    Random lifts_;     // apart from random_, so that the noise of lifts does not change reaches
    Random presses_;   // likewise, for the noise of learned forces
    double now_ = 0;   // [s]
    double tick_ = 0;  // time since the last Frame [s]
    Eyes eyes_;
    Touch touch_;
    double half_ = 0;               // half the aperture of the handles [m]
    double touched_ = 0;            // value of half_ when both fingers touched [m]
    Vec3 centre_ = Vec3::Zero();    // middle of the handles [m]
    Vec3 velocity_ = Vec3::Zero();  // of the middle of the handles [m/s]
    double felt_ = 0;          // force on a finger, smoothed like the stiffness it determines [N]
    Past<Vec3> velocities_;    // of the middle of the handles [m/s]
    Past<Strain> strains_;     // read with the delay of sight, to be compared with it
    std::vector<Vec3> known_;  // last seen position of each region [m]
    HeldCursor cursor_;
    uint32_t seen_ = 0;  // regions that have been seen, one bit per region

    // memory
    Learned before_;  // what was learned in earlier sessions
    std::vector<std::string> bodies_;
    std::vector<size_t> memory_;  // by state: which of the following it uses
    std::vector<char> appears_;   // by state: whether a hidden cursor appeared later, the last time
    std::vector<RotationMemory> rotations_;  // by the first state that uses it
    std::vector<GainMemory> gains_;          // likewise
    std::vector<ForceMemory> forces_;        // likewise
    Grip grip_;

    // actions
    enum class Doing { nothing, waiting, moving, preloading, loading, releasing };
    Doing doing_ = Doing::nothing;
    Strokes aim_;
    int trial_ = 0;
    int attempt_ = 0;
    int phase_ = 0;
    int acting_ =
        0;  // state whose steps are performed; later states without steps do not change it
    bool between_ = true;    // between trials
    double since_ = 0;       // start of the state, of the time between trials, or of idle time [s]
    double wait_until_ = 0;  // [s]
    size_t step_ = 0;
    Aim pending_;              // current movement; in a lift, it starts when the object lifts off
    double pending_time_ = 0;  // duration of pending_ [s]
    int corrections_ = 0;
    double missed_ = 0;    // distance from the target before the last correction [m]
    double moved_at_ = 0;  // last time when the hand was felt to move [s]
    Vec3 off_felt_ =
        Vec3::Zero();   // last seen distance from the felt hand to the displayed one [m]
    double delay_ = 0;  // hesitation before the next movement of this trial [s]
    struct Reach {
        bool going = false;
        bool mended = false;  // whether the reach was corrected on the way
        bool seen = false;    // whether its direction error was seen
        bool ended = false;   // whether its first stroke has ended and its extent was judged
        bool pushed = false;  // whether a push was felt before its error was judged
        int number = 0;       // from 1
        size_t state = 0;     // index of the state in which it began
        bool hidden = false;  // whether it began without a cursor
        double shows = 1;     // share of learned rotations that it shows
        size_t memory = 0;    // index into rotations_, gains_ and forces_
        Vec3 cursor_off = Vec3::Zero();  // jump of the cursor that is not answered yet [m]
        double jumped_at = 0;            // last time without such a jump, or one of the target [s]
        int jumps = 0;                   // number of jumps of the display that were answered
        Vec3 from = Vec3::Zero();        // displayed position of the hand at the start [m]
        Vec3 felt_from = Vec3::Zero();   // felt position of the hand at the start [m]
        Vec3 way = Vec3::Zero();         // displacement that the display should show [m]
        Vec3 error = Vec3::Zero();       // rotation vector from `way` to the hand's direction [rad]

        double begin = 0;             // start time of its first stroke [s]
        double duration = 0;          // duration of its first stroke [s]; 0 if not started
        Vec3 along = Vec3::Zero();    // unit vector of the intended direction
        Vec3 goal = Vec3::Zero();     // where the target was seen [m]
        Vec3 strayed = Vec3::Zero();  // deviation of the first stroke from `along` by noise [m]
        // by how much it has strayed, how much of that the hand has followed, and their rates
        Vec3 strayed_so_far = Vec3::Zero();  // [m]
        Vec3 straying = Vec3::Zero();        // [m/s]
        Vec3 followed = Vec3::Zero();        // [m]
        Vec3 following = Vec3::Zero();       // [m/s]
        Vec3 held_back = Vec3::Zero();       // difference that is made by what holds the hand [m]
        Vec3 held_back_rate = Vec3::Zero();  // [m/s]
        Vec3 expects = Vec3::Zero();         // push expected, per speed along `along` [N*s/m]
        Vec3 presses = Vec3::Zero();  // force that opposes a push, per speed along `along` [N*s/m]
        Vec3 push = Vec3::Zero();     // sum of push times speed [N*m/s]
        double lag = 0;               // time by which a push is expected to follow the speed [s]
        // sums over the ticks, from which it is learned how much later the push came
        Vec3 pushes = Vec3::Zero();        // of the push [N]
        Vec3 timed_pushes = Vec3::Zero();  // of the push times its time [N*s]
        double speeds = 0;                 // of the speed [m/s]
        double timed_speeds = 0;           // of the speed times its time [m]
        int ticks = 0;
        double moved = 0;  // sum of squared speed [m^2/s^2]; 0 if nothing pushed
    };
    Reach reach_;

    // answers
    Vec3 shown_from_ = Vec3::Zero();  // displayed start of the last sufficiently long movement [m]
    Vec3 felt_from_ = Vec3::Zero();   // felt start of that movement [m]
    double answer_at_ = -1;           // time of the answer [s]; negative if there is no question
    size_t rated_ = 0;                // number of questions of the state that have been answered
    char key_ = 0;
    std::array<char, 12> typed_{};  // digits of the answer being typed
    size_t typed_length_ = 0;
    size_t typed_at_ = 0;
};

}  // namespace dihaptic::person
