// The trials of a session: their order, generated once from the task, the participant's number and
// the seed, and the queue to which trials that must be repeated return.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/random.h"
#include "base/table.h"
#include "rows/trial_row.h"
#include "task/file/task.h"

namespace dihaptic::task {

struct Trial {
    int block = 0;     ///< index of the block in the task
    int number = 1;    ///< number of the block in the session, from 1
    int in_block = 1;  ///< number of the trial in the block, from 1
    int round = 0;     ///< index of the round; for a trial outside all rounds, the number of rounds
    int condition = 0;
    TrialKind kind = TrialKind::baseline;
    std::vector<int> perturb;  ///< indices of the trial's perturbations in the task
    int procedure = -1;        ///< index of the procedure that chooses the share; -1 for none
    double share = 1;  ///< share with which the perturbations act; NaN if a procedure chooses it
    std::vector<double> draws{};  ///< values of the task's draws in this trial (task/file/draws.h)
};

/// Separator between names in the column `perturbation`.
inline constexpr std::string_view kBetweenNames = " + ";
/// Whether a cell of the column `perturbation` contains this name, alone or with others.
bool names_perturbation(const std::string& cell, const std::string& name);

/// Returns 0 to n - 1 in the order for a participant. Shuffled: a random order from `random`. Latin
/// square: row `number` of Williams's design, in which each item follows every other item equally
/// often (two squares for odd n; Williams 1949). Counterbalanced: permutation `number` of all n!
/// permutations in lexicographic order.
std::vector<int> ordered(int n, Order order, int number, Random& random);

/// After how many participants each order of n items has come up equally often; 1 if the order does
/// not depend on the participant's number.
int orders_of(int n, Order order);
/// Orders of conditions within a block, or of rounds, that depend on the participant's number.
struct NumberedOrder {
    std::string of;  ///< what is ordered: the rounds, or the conditions of a block
    int orders = 1;  ///< after how many participants each of them has come up equally often
};
std::vector<NumberedOrder> numbered_orders(const Task& task);

/// Returns the number at the end of a participant's identifier, e.g. 7 for S07, or -1 if there is
/// none.
int participant_number(const std::string& id);
/// Whether the order of the task's trials or any of its draws depends on the participant's number.
bool needs_number(const Task& task);

/// Generates all trials, in order. The task must have passed plan_task() without errors.
std::vector<Trial> make_trials(const Task& task, int number, uint64_t seed);

/// Columns of trial-list.csv, which trials.csv repeats for each trial. These columns are followed
/// by those for the task's factors and draws and, in trial-list.csv, by those for the measurement
/// of a reach.
inline const std::vector<Table::Column> kTrialListColumns = list_figures(rows::AskedRow{}).columns;
/// Returns the name of the column in trials.csv that contains a variable's value after the trial,
/// in the unit of the variable's name.
inline std::string next_column(const std::string& variable) {
    return "next_" + variable;
}
/// Returns the columns for the task's factors and draws.
std::vector<Table::Column> own_columns(const Task& task);
/// Makes trial-list.csv, with one row per trial.
Table trial_list(const Task& task, const std::vector<Trial>& trials);
/// Reads trial-list.csv. Throws Error if the file does not list trials of this task.
std::vector<Trial> read_trial_list(const Task& task, const std::string& file);

/// A trial attempt, read from a row of trials.csv.
struct Attempt {
    int trial = 0;     ///< index of the trial in the session
    int attempt = 1;   ///< number of the attempt in this trial, counted from 1
    int outcome = -1;  ///< index of the outcome in the task; -1 if the attempt was interrupted or
                       ///< its end was not recorded
    std::vector<double> variables{};  ///< values of the variables after the attempt [SI]
};

/// The queue of trials still to be done. It does not allocate after construction.
class TrialQueue {
  public:
    TrialQueue(const std::vector<Trial>& trials, Redo redo, int most_attempts, uint64_t seed);

    bool empty() const { return at_ == queue_.size(); }
    /// Index of the next trial or, during a trial, of the running one. The queue must not be empty.
    int trial() const { return queue_[at_]; }
    /// Number of the current attempt at that trial, counted from 1.
    int attempt() const { return attempts_[static_cast<size_t>(trial())]; }
    /// Ends the trial. If `redo` is true, the trial will be repeated according to the policy,
    /// unless it has already had most_attempts attempts.
    void finish(bool redo) noexcept;

    /// Moves this attempt to the front of the queue. Used when an earlier part of the session, in
    /// which this attempt came next, is replayed. Trials that were due before it remain in the
    /// queue, since their outcomes are unknown. Returns false if the trial is no longer in the
    /// queue.
    bool go_to(int trial, int attempt) noexcept;

    /// Removes all remaining trials from the queue.
    void end() noexcept {
        left_out_ = queue_.size() - at_;
        at_ = queue_.size();
    }
    size_t left_out() const { return left_out_; }

    /// Counts a new attempt at the trial, which restarts after an unrelated interruption.
    void again() noexcept { ++attempts_[static_cast<size_t>(trial())]; }

    int done() const { return static_cast<int>(at_); }
    int all() const { return static_cast<int>(queue_.size()); }

  private:
    const std::vector<Trial>* trials_;
    Redo redo_;
    int most_attempts_;
    Random random_;
    std::vector<int> queue_;     // elements before index at_ are trials that have been done
    std::vector<int> attempts_;  // number of the attempt at each trial
    size_t at_ = 0;
    size_t left_out_ = 0;  // by end()
};

}  // namespace dihaptic::task
