// A simulated person: sees what is shown, feels the handles, and moves the simulated hand. It has
// been told what each state of the task asks (the file's hand steps), and knows nothing of trials'
// kinds and perturbations: these it sees and feels, or not.
#pragma once

#include <memory>

#include "experiment/plan.h"
#include "experiment/seeing_driver.h"
#include "person/eyes.h"
#include "person/gain_memory.h"
#include "person/grip.h"
#include "person/rotation_memory.h"
#include "person/traits.h"

namespace dihaptic::person {

class Person final : public experiment::SeeingDriver {
  public:
    /// For a plan with trials. Throws Error when the plan's hand is none that a task can move.
    Person(const Traits& traits, const experiment::Plan& plan);

    double duration() const override { return hand::kLongestScript; }
    const std::vector<Phase>& phases() const override { return phases_; }
    void restart() override;

    /// What it expects to be turned, of targets in direction d, while in a state of the task.
    Vec3 expected_rotation(size_t state, const Vec3& d) const {
        return rotations_[state].expected(d);
    }
    const Grip& grip() const { return grip_; }

  private:
    hand::FingerTarget do_target(int finger, double t) const noexcept override;
    void do_see(const servo::Frame& frame) noexcept override;
    char do_take_key() noexcept override { return std::exchange(key_, '\0'); }

    void measure(const servo::Frame& frame) noexcept;
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
    void watch_reach(const Sight& sight) noexcept;
    void end_reach() noexcept;
    bool correct(const Sight& sight) noexcept;
    bool from_above(const Vec3& displacement) const noexcept;
    Vec3 made_for(const Vec3& displacement) const noexcept;
    void judge_extent(const Sight& sight) noexcept;
    Vec3 target(const Sight& sight, const experiment::TaskPlan::Step& step) const noexcept;
    void answer(const Sight& sight) noexcept;
    double stiffness() const noexcept;
    double noisy(double value, double share) noexcept;
    const std::vector<experiment::TaskPlan::Step>& steps() const noexcept;

    Traits traits_;
    std::shared_ptr<const experiment::TaskPlan> plan_;
    std::vector<hand::FingerPlace> places_;
    hand::Impedance impedance_;
    Aim start_;
    uint64_t seed_;
    std::vector<Phase> phases_;

    // senses
    Random random_;
    double now_ = 0;  // [s]
    Eyes eyes_;
    Touch touch_;
    double half_ = 0;             // aperture of the handles, halved [m]
    double touched_ = 0;          // ... when both fingers touched
    Vec3 centre_ = Vec3::Zero();  // of the handles [m]
    double felt_ = 0;             // force on a finger, as its stiffness follows it [N]
    std::vector<Vec3> known_;     // regions, where they were seen last [m]
    uint32_t seen_ = 0;           // which of them were

    // memory
    // by state: what is learned in one stays there
    std::vector<RotationMemory> rotations_;
    std::vector<GainMemory> gains_;
    Grip grip_;

    // what it does
    enum class Doing { nothing, waiting, moving, preloading, loading, releasing };
    Doing doing_ = Doing::nothing;
    Strokes aim_;
    int trial_ = 0;
    int attempt_ = 0;
    int phase_ = 0;
    int acting_ = 0;  // the state whose steps are done; later ones without steps leave it as it is
    bool between_ = true;
    double since_ = 0;  // when this began: the state, the time between trials, or being done [s]
    double wait_until_ = 0;  // [s]
    size_t step_ = 0;
    Aim pending_;              // once the object is felt to come off ...
    double pending_time_ = 0;  // ... in so long [s]
    int corrections_ = 0;
    double delay_ = 0;  // of this trial's next movement: hesitation [s]
    struct Reach {
        bool going = false;
        bool mended = false;
        bool seen = false;
        bool ended = false;  // its first stroke, and how far it went was seen
        size_t state = 0;
        Vec3 from = Vec3::Zero();  // where the hand was shown [m]
        Vec3 way = Vec3::Zero();   // that it is to be shown to go [m]
        Vec3 error = Vec3::Zero();
    };
    Reach reach_;

    // answers
    Vec3 shown_from_ = Vec3::Zero();  // of the last movement worth judging [m]
    Vec3 felt_from_ = Vec3::Zero();
    double answer_at_ = -1;  // [s]; negative: nothing is asked
    char key_ = 0;
};

/// Puts a person before the plan's task, in place of the file's hand.
void sit_down(experiment::Plan& plan, const Traits& traits);

}  // namespace dihaptic::person
