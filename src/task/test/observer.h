// A simulated observer with a known psychometric function, who compares the friction of a block in
// the two intervals of a trial and presses 1 or 2, and an experiment that asks for this comparison.
#pragma once

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/random.h"
#include "model/psychometric.h"
#include "session/test/reaches.h"
#include "task/test/resting_hand.h"

namespace dihaptic::task::test {

/// An experiment in which PROCEDURE stands for the procedure that chooses the levels. A level is
/// how much more slippery the block is in the comparison.
inline const char* const kIntervals = R"(title: Two intervals
scene: scene.yaml
hand: { centre_mm: [0, 0, 120] }
task:
  perturbations:
    - name: felt
      body: { body: block, friction_scale: 1 + more }
  states:
    - { name: first, interval: 1, exits: [{ when: time, after_s: 0.002, to: pause }], simulated_hand: [{ duration_s: 0.1 }] }
    - { name: pause, perturbed: no, exits: [{ when: time, after_s: 0.001, to: second }] }
    - { name: second, interval: 2, exits: [{ when: time, after_s: 0.002, to: answer }] }
    - name: answer
      perturbed: no
      message: Which was rougher? 1 or 2
      exits:
        - { when: key, key: "1", chooses: 1 }
        - { when: key, key: "2", chooses: 2 }
        - { when: time, after_s: 5, outcome: late, redo: yes }
  procedures:
    - name: rougher
      level: more
      perturb: felt
      standard: 0
      design: 2afc
      PROCEDURE
  blocks:
    - { name: thresholds, kind: perturbed, procedures: [rougher] }
)";

struct Intervals : session::Files {
    explicit Intervals(const std::string& procedure) {
        experiment = kIntervals;
        replace("PROCEDURE", procedure);
    }
};

struct IntervalTrial {
    double level = 0;     ///< level as recorded
    double standard = 0;  ///< friction_scale in the interval with the standard
    double comparison = 0;
    bool chose_comparison = false;
    std::string outcome;
    Attempt attempt;
};

/// Runs trials, starting after those in `done`, until the session is over or `most` trials are
/// done.
inline std::vector<IntervalTrial> observe(const session::Plan& plan,
                                          const model::Psychometric& observer, Random& random,
                                          const std::vector<Attempt>& done = {},
                                          size_t most = 100000) {
    RestingHand hand(plan, done);
    std::vector<IntervalTrial> out;
    std::map<int, double> felt;  // friction_scale felt in each phase
    while (out.size() < most) {
        const frame::Commands& commands = hand.tick();
        if (!commands.task.properties.empty())
            felt[commands.phase] = commands.task.properties.front().friction_scale;
        if (commands.phase == 4 && commands.task.outcome < 0) {
            const double more = std::abs(felt[1] - felt[3]);
            const bool right = random.uniform(0, 1) < observer.probability(more);
            hand.director.press((felt[1] > felt[3]) == right ? '1' : '2');
        }
        if (commands.task.outcome >= 0) {
            const Trial& trial = plan.task->trials[static_cast<size_t>(commands.trial) - 1];
            const int interval = plan.task->interval_of(trial);
            IntervalTrial& now = out.emplace_back();
            now.level = commands.task.variables.back().value;
            now.comparison = felt[interval == 1 ? 1 : 3];
            now.standard = felt[interval == 1 ? 3 : 1];
            now.outcome = plan.task->outcomes[static_cast<size_t>(commands.task.outcome)].name;
            now.chose_comparison = now.outcome == "comparison";
            now.attempt = {commands.trial - 1, commands.task.attempt, commands.task.outcome};
            felt.clear();
        }
        if (commands.stop) break;
    }
    return out;
}

}  // namespace dihaptic::task::test
