// The trials of a session: their order, generated once from the task, the participant's number and
// the seed, and the queue to which trials that must be repeated return.
#pragma once

#include <string_view>

#include "base/random.h"
#include "base/table.h"
#include "rows/trial_row.h"
#include "task/file/task.h"

namespace dihaptic::task {

struct Trial {
    int block = 0;     ///< index of the block in the task
    int number = 1;    ///< number of the block in the session, from 1
    int in_block = 1;  ///< number of the trial in the block, from 1
    int round = 0;     ///< index; for a trial outside all rounds, the number of rounds
    int condition = 0;
    TrialKind kind = TrialKind::baseline;
    std::vector<int> perturb;     ///< indices of perturbations in the task
    int procedure = -1;           ///< index of the procedure that chooses the share; -1: none
    double share = 1;             ///< share of the perturbations; NaN if a procedure chooses it
    std::vector<double> draws{};  ///< values of the task's draws (task/file/draws.h)
};

/// Separator of names in the column `perturbation`.
inline constexpr std::string_view kBetweenNames = " + ";
/// Whether a cell of the column `perturbation` names the perturbation, alone or with others.
bool names_perturbation(const std::string& cell, const std::string& name);

/// Returns 0 to n - 1 in a participant's order. Shuffled: with `random`. Latin square: row
/// `number` of Williams's design, in which each item follows each other item equally often (two
/// squares for odd n; Williams 1949). Counterbalanced: permutation `number` of all n! in
/// lexicographic order.
std::vector<int> ordered(int n, Order order, int number, Random& random);

/// The number at the end of a participant's identifier, e.g. 7 for S07; -1 if there is none.
int participant_number(const std::string& id);
/// Whether the order of the task's trials, or a draw, depends on the participant's number.
bool needs_number(const Task& task);

/// Generates all trials, in order. The task must have passed plan_task() without errors.
std::vector<Trial> make_trials(const Task& task, int number, uint64_t seed);

/// Columns of trial-list.csv, which trials.csv repeats for each trial. They are followed by columns
/// for the task's factors and draws and, in trial-list.csv, for the measurement of a reach.
inline const std::vector<Table::Column> kTrialListColumns = list_figures(rows::AskedRow{}).columns;
/// Column of trials.csv with a variable's value after the trial, in the unit of its name.
inline std::string next_column(const std::string& variable) {
    return "next_" + variable;
}
/// Columns for the task's factors and draws.
std::vector<Table::Column> own_columns(const Task& task);
/// trial-list.csv: one row per trial.
Table trial_list(const Task& task, const std::vector<Trial>& trials);
/// Reads trial-list.csv. Throws Error if it is not a list of this task's trials.
std::vector<Trial> read_trial_list(const Task& task, const std::string& file);

/// An attempt at a trial, from a row of trials.csv.
struct Attempt {
    int trial = 0;     ///< index in the session's trials
    int attempt = 1;   ///< number of the attempt at this trial, from 1
    int outcome = -1;  ///< index of the outcome in the task; -1: interrupted, or end not recorded
    std::vector<double> variables{};  ///< values after the attempt [SI]
};

/// The trials still to be done. Once constructed, it allocates nothing.
class TrialQueue {
  public:
    TrialQueue(const std::vector<Trial>& trials, Redo redo, int most_attempts, uint64_t seed);

    bool empty() const { return at_ == queue_.size(); }
    /// Index of the next trial, or of the running one. The queue must not be empty.
    int trial() const { return queue_[at_]; }
    /// Number of the attempt at that trial, from 1.
    int attempt() const { return attempts_[static_cast<size_t>(trial())]; }
    /// Ends the trial. With `redo` the trial is repeated according to the policy, unless it has
    /// reached most_attempts.
    void finish(bool redo) noexcept;

    /// Moves this attempt to the front, when an earlier part of the session in which it came next
    /// is replayed. Trials that were due before it remain in the queue, since their outcomes are
    /// unknown. Returns false if the trial is no longer in the queue.
    bool go_to(int trial, int attempt) noexcept;

    /// Leaves out the remaining trials.
    void end() noexcept {
        left_out_ = queue_.size() - at_;
        at_ = queue_.size();
    }
    size_t left_out() const { return left_out_; }

    /// Restarts the trial after an unrelated interruption.
    void again() noexcept { ++attempts_[static_cast<size_t>(trial())]; }

    int done() const { return static_cast<int>(at_); }
    int all() const { return static_cast<int>(queue_.size()); }

  private:
    const std::vector<Trial>* trials_;
    Redo redo_;
    int most_attempts_;
    Random random_;
    std::vector<int> queue_;     // trials before index at_ are done
    std::vector<int> attempts_;  // by trial
    size_t at_ = 0;
    size_t left_out_ = 0;  // by end()
};

}  // namespace dihaptic::task
