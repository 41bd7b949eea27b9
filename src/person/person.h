// A simulated person who sees the display, feels the handles, and moves the simulated hand. The
// person knows what each state of the task demands (the hand steps in the file), but not the kinds
// of trials or the perturbations, which can only be seen and felt. The fingers of a second hand
// follow the steps that name them, exactly as written in the file. person_reach.cpp contains its
// reaches, person.cpp all else.
#pragma once

#include <memory>
#include <optional>

#include "person/answers.h"
#include "person/grip.h"
#include "person/learned.h"
#include "person/reach.h"
#include "person/senses.h"
#include "person/state_memories.h"
#include "person/strokes.h"
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
    const RotationMemory& rotations(size_t state) const { return memories_.of(state).rotation; }
    const ForceMemory& forces(size_t state) const { return memories_.of(state).force; }

  private:
    /// The random numbers of a person, of several kinds: what is drawn for one of them does not
    /// change the others.
    struct Draws {
        Draws(uint64_t seed, const std::string& id);

        uint64_t seed;
        Random others;
        Random lifts;    // noise of lifts
        Random presses;  // noise of learned forces
    };
    /// Where in the task the person believes to be.
    struct Cue {
        int trial = 0;
        int attempt = 0;
        int phase = 0;
        bool between = true;  // between trials
    };
    enum class Doing { nothing, waiting, moving, preloading, loading, releasing };
    /// What the person is doing.
    struct Action {
        Doing doing = Doing::nothing;
        int state = 0;  // whose steps are performed; later states without steps do not change it
        size_t step = 0;
        Aim way;              // current movement; in a lift, it starts when the object lifts off
        double duration = 0;  // of that movement [s]
        int corrections = 0;
        double missed = 0;   // distance from the target before the last correction [m]
        double touched = 0;  // half the aperture when both fingers touched [m]
        double since = 0;    // start of the state, of the time between trials, or of idle time [s]
        double wait_until = 0;  // [s]
        double delay = 0;       // hesitation before the next movement of this trial [s]
    };

    static constexpr double kReach =
        0.03;  // shortest movement from which rotations are learned [m]
    static constexpr double kShortest = 0.2;  // shortest duration of a stroke [s]

    hand::FingerTarget do_target(int finger, double t) const noexcept override;
    void do_see(const frame::Frame& frame) noexcept override;
    char do_take_key() noexcept override;

    void follow_cues(const Sight& sight) noexcept;
    void await_trial() noexcept;
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
    bool shows_earlier_reach() const noexcept;
    bool from_above(const Vec3& displacement) const noexcept;
    Vec3 made_for(const Vec3& displacement) const noexcept;
    void judge_extent(const Sight& sight) noexcept;
    Vec3 target(const Sight& sight, const task::TaskPlan::Step& step) const noexcept;
    double stiffness() const noexcept;
    double noisy(double value, double share) noexcept;
    const std::vector<task::TaskPlan::Step>& steps() const noexcept;

    StateMemory& memory() noexcept { return memories_.of(reach_.state); }
    const StateMemory& memory() const noexcept { return memories_.of(reach_.state); }

    Traits traits_;
    std::shared_ptr<const task::TaskPlan> plan_;
    task::TrialNumbers numbers_;
    hand::Impedance impedance_;
    std::optional<task::TaskHand> other_;  // moves the fingers of other hands, which feel nothing
    std::vector<Phase> phases_;
    Draws draws_;

    // senses
    double now_ = 0;   // [s]
    double tick_ = 0;  // time since the last Frame [s]
    Senses senses_;
    Aim start_;

    // memory
    Learned before_;                                        // what was learned in earlier sessions
    std::vector<std::vector<task::TaskPlan::Step>> steps_;  // by state
    StateMemories memories_;
    Grip grip_;

    // actions
    Cue cue_;
    Action action_;
    Strokes aim_;
    Reach reach_;
    Answers answers_;
};

}  // namespace dihaptic::person
