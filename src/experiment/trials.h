// The trials of a session: their order, made once from the task, the participant's number and the
// seed, and what becomes of those that have to be done again.
#pragma once

#include "base/random.h"
#include "base/table.h"
#include "experiment/task.h"

namespace dihaptic::experiment {

struct Trial {
    int block = 0;     ///< index among the task's
    int number = 1;    ///< of the block in the session, from 1
    int in_block = 1;  ///< from 1
    int round = 0;
    int condition = 0;
    TrialKind kind = TrialKind::baseline;
    int perturb = -1;    ///< index among the task's perturbations; -1: none
    int procedure = -1;  ///< index among the task's, which chooses the share; -1: none does
    double share = 1;    ///< of the perturbation; NaN where a procedure chooses it
};

/// 0 to n - 1 in the order for a participant. Shuffled: from `random`. Latin square: row `number`
/// of Williams's design, in which each item follows each other one equally often (two squares for
/// odd n; Williams 1949). Counterbalanced: permutation `number` of all n! in lexicographic order.
std::vector<int> ordered(int n, Order order, int number, Random& random);

/// The number at the end of a participant's identifier, S07: 7; -1: there is none.
int participant_number(const std::string& id);
/// Whether the order of the task's trials depends on it.
bool needs_number(const Task& task);

/// All trials, in order. The task is in order itself.
std::vector<Trial> make_trials(const Task& task, int number, uint64_t seed);

/// trial-list.csv: a row a trial, and back.
Table trial_list(const Task& task, const std::vector<Trial>& trials);
/// Throws Error when the file is no list of this task's trials.
std::vector<Trial> read_trial_list(const Task& task, const std::string& file);

/// What a row of trials.csv says of an attempt at a trial.
struct Attempt {
    int trial = 0;     ///< index among the session's
    int attempt = 1;   ///< at it, from 1
    int outcome = -1;  ///< index among the task's; -1: it was interrupted, or its end is lost
};

/// What is still to be done. It allocates nothing once it is made.
class TrialQueue {
  public:
    TrialQueue(const std::vector<Trial>& trials, Redo redo, int most_attempts, uint64_t seed);

    bool empty() const { return at_ == queue_.size(); }
    /// Index of the trial that is next, or goes on; not of an empty queue.
    int trial() const { return queue_[at_]; }
    /// At it, from 1.
    int attempt() const { return attempts_[static_cast<size_t>(trial())]; }
    /// The trial is over; with `redo` it is done again as the policy says, unless it was attempted
    /// often enough.
    void finish(bool redo) noexcept;

    /// This attempt was made next, in an earlier part of the session. What was to come before it is
    /// still to be done: how it ended is not known. False: nothing is left of that trial.
    bool go_to(int trial, int attempt) noexcept;

    /// The trial begins anew: something that is none of its business interrupted it.
    void again() noexcept { ++attempts_[static_cast<size_t>(trial())]; }

    int done() const { return static_cast<int>(at_); }
    int all() const { return static_cast<int>(queue_.size()); }

  private:
    const std::vector<Trial>* trials_;
    Redo redo_;
    int most_attempts_;
    Random random_;
    std::vector<int> queue_;     // those done before at_
    std::vector<int> attempts_;  // by trial
    size_t at_ = 0;
};

}  // namespace dihaptic::experiment
